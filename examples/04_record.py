"""A walk as arrays: how far each foot slipped, and how long it stood."""

import numpy as np

from polypod import World, load_rig, read_record, record_walk, write_record

world = World()
world.add(load_rig("spider"), speed=0.4)
(walk,) = record_walk(world, seconds=4.0, fps=60.0)
write_record(walk, "run.npz")

record = read_record("run.npz")
for k, name in enumerate(record.foot_name):
    stands = record.foot_stance[:, k]
    both = stands[1:] & stands[:-1]
    slip = np.linalg.norm(np.diff(record.foot_position[:, k], axis=0), axis=1)[both]
    print(f"{name}: stood {stands.mean():.0%} of the time, slipped {slip.max() * 1000:.3g} mm")
