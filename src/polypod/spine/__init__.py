"""A spine that bends: P2's four steps, a file each, and the frames in which legs hang (P2 5)."""
