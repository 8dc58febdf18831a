"""Where a creature walks: terrain, obstacles, and the maps made of them."""

from polypod.environment.environment import Environment
from polypod.environment.obstacles import Obstacle
from polypod.environment.scattering import scatter
from polypod.environment.terrain import Terrain
from polypod.environment.tiled import TiledTerrain

__all__ = ["Environment", "Obstacle", "Terrain", "TiledTerrain", "scatter"]
