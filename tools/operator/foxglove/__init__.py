"""The bridge between the robot and Foxglove (README.md)."""
