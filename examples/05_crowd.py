"""A hundred spiders among crates, and how long a frame takes."""

import time

from polypod import Terrain, World, load_rig, scatter

ground = Terrain.flat()
crates = scatter(ground, 400, (-10, -10, 10, 10), ((0.1, 0.04, 0.1), (0.3, 0.08, 0.3)), seed=1)
world = World(ground, crates)
herd = world.add(load_rig("spider"), count=100, speed=0.4)
world.step(1 / 30)  # compiles, the first time

start = time.perf_counter()
for _ in range(60):
    world.step(1 / 30)
print(f"{herd.count} spiders: {(time.perf_counter() - start) / 60 * 1000:.1f} ms a frame")
