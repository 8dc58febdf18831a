"""What can be drawn over the scene by the server's word; the page draws others by itself."""

OVERLAYS = ("cells", "candidates", "paths", "hull")
