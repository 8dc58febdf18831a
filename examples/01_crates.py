"""A spider crosses a field of crates: leaves crates.glb and crates.png."""

from pathlib import Path

from polypod import World, load_rig, read_scene, record_walk, write_glb, write_strip

scene = read_scene(Path(__file__).parent / "scenes" / "crates.toml")
environment = scene.environment()
world = World(environment)
spiders = world.add(load_rig("spider"), position=[0.0, 0.0], gait="spider", speed=0.4)

(walk,) = record_walk(world, seconds=8.0, fps=30.0)

write_glb(walk, "crates.glb")
write_strip(walk, environment.table, "crates.png")
