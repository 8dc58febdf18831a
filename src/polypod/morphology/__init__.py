"""What a creature is: legs, joint limits, body, and the creatures built in."""
