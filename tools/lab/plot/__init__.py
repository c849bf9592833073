"""ale-plot: runs as pictures."""
