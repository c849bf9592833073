"""ale-fleet: many drives judged at once, or joined."""
