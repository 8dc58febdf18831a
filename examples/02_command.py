"""A herd on hills is given other orders while it walks, and is pushed: speed, gait, height."""

import numpy as np

from polypod import Terrain, World, load_rig, make_gait

world = World(Terrain.hills(seed=2, relief=0.4))
spider = load_rig("spider")
herd = world.add(spider, count=4, speed=0.3)


def walk(seconds: float) -> None:
    for _ in range(round(seconds * 30)):
        world.step(1 / 30)
    x, y, z = herd.state.position[0]
    print(f"at {world.time:4.1f} s the first is at x {x:.2f}, y {y:.2f}, z {z:.2f} m")


walk(1.0)
herd.command.speed = [0.2, 0.3, 0.4, 0.5]  # one for each creature
herd.command.heading = np.radians([0.0, 30.0, 60.0, 90.0])
walk(1.0)
herd.command.set_gait(make_gait("wave", spider.legs.side, spider.legs.row))
walk(1.0)
herd.command.body_height = 0.8 * spider.body.height  # it ducks
herd.command.spacing = 0.1 * np.sign(spider.legs.sole_stance[:, [0, 2]])  # and spreads its feet
walk(1.0)
herd.push([0.4, 0.0, 0.0], creature=0)  # m/s: it steps aside to catch itself, and comes back
walk(1.0)
herd.command.speed = 0.0
walk(1.0)
