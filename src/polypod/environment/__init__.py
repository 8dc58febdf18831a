"""Where a creature walks: terrain, obstacles, and the maps made of them."""
