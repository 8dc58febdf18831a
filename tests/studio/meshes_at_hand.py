"""Meshes for tests, as OBJ."""

from __future__ import annotations

CORNERS = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
SIDES = ["1 2 4 3", "5 7 8 6", "1 5 6 2", "3 4 8 7", "1 3 7 5", "2 6 8 4"]


def block(x: float, y: float, z: float, sides: int = 6) -> bytes:
    """Return a block of so many metres; with fewer sides it is open."""
    lines = [f"v {a * x} {b * y} {c * z}" for a, b, c in CORNERS]
    return "\n".join([*lines, *(f"f {side}" for side in SIDES[:sides])]).encode()


# The numbers of the corners of one face.
WIDE_FACE = b"f " + b" ".join(b"%d" % (i + 1) for i in range(3000))
