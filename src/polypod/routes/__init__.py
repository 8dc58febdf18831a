"""A way at body scale round what a creature cannot pass."""
