"""A gait of one's own: a tetrapod that limps on one foot, written, read back, and walked."""

from polypod import Gait, World, load_rig, make_gait, read_gait, write_gait

spider = load_rig("spider")
tetrapod = make_gait("tetrapod", spider.legs.side, spider.legs.row)
extent = tetrapod.swing_extent.copy()
extent[-1] += 0.2  # the last foot stays up longer
limp = Gait("limp", tetrapod.swing_start, extent, family="arthropod")
write_gait(limp, "limp.toml")

world = World()
herd = world.add(spider, gait=read_gait("limp.toml"), speed=0.3)
down = 0
for _ in range(150):
    world.step(1 / 30)
    down += int(not herd.state.swinging[0, -1])
print(f"the limping foot stood for {down / 150:.0%} of the time; others for {limp.duty:.0%}")
