"""Joint rotations that put each sole where it was planned."""
