"""What each foot and the body do next, on the ground plane."""
