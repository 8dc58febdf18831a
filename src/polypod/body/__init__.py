"""How high the body is held, and how it tilts."""
