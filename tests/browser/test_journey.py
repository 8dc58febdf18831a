"""The whole way of a first visit: from the page as it opens to a file with one's own walk."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hands import (
    centre,
    drag_by,
    drag_slider,
    drop_file,
    in_use,
    name_of,
    pixels,
    turn_handle,
)

from polypod.morphology.builtin import build
from polypod.report.arrays import rotate_all
from polypod.report.record import Record, read_record
from polypod.rigs.gltf import GltfDocument
from polypod.rigs.playback import Playback

FOOT = 2  # of the spider's, whose sector and place are dragged
LONG = 120.0  # s: a machine that has other things to do walks slower than it should
# Every frame that comes, as far as it is asked about below.
WATCH = """
window.seen = [];
polypod.on("frame", (frame) => {
  if (frame.tapeFrame !== null) return;
  const { body, pose } = frame.herds[0];
  window.seen.push({
    time: frame.time,
    body: Array.from(body.slice(4, 7)),
    pose: polypod.tape.recording ? Array.from(pose) : null,
    stance: frame.focus.feet.map((foot) => foot.stance),
    extent: frame.focus.feet.map((foot) => foot.extent),
  });
});
null; // what a browser is asked for must be no function
"""


class Walk:
    """What the page was sent since now, until it has walked for so long."""

    def __init__(self, tab: Any) -> None:
        self.tab = tab
        self.frames = 0
        tab.ask("window.seen.length = 0")

    def wait(self, seconds: float) -> Walk:
        lasts = "seen.length ? seen.at(-1).time - seen[0].time : 0"
        self.tab.until(lambda: self.tab.ask(lasts) > seconds, f"it walks for {seconds:g} s", LONG)
        self.frames = self.tab.ask("seen.length")
        return self

    def of(self, key: str) -> np.ndarray:
        return np.array(self.tab.ask(f"seen.slice(0, {self.frames}).map((one) => one.{key})"))


def test_from_the_first_look_to_a_walk_of_ones_own(
    tab: Any, shared_rig: Any, tmp_path: Path
) -> None:
    tab.ask(WATCH)
    tab.keep("journey-01-opened")
    walk_faster(tab)
    drag_a_sectors_end(tab)
    drag_a_foot(tab)
    walk_ones_own(tab, own_rig(shared_rig))
    step_on_a_crate(tab, tmp_path)
    push_it(tab)
    blend_to_a_trot(tab)
    take_it_away(tab, tmp_path)


def walk_faster(tab: Any) -> None:
    tab.open_panel("Body")
    most = tab.ask("polypod.creature.ranges.speed.most")
    before = Walk(tab).wait(1.0).of("body")
    drag_slider(tab, "Speed", 0.25)
    wanted = pytest.approx(0.25 * most, rel=0.05)
    tab.until(lambda: tab.document["command"]["speed"] == wanted, "a speed is asked for")
    speed = tab.document["command"]["speed"]
    tab.until(lambda: tab.ask("polypod.frame.focus.speed") > 0.95 * speed, "it is as fast")
    walk = Walk(tab).wait(1.0)
    went = np.ptp(walk.of("body")[:, 2]) / np.ptp(walk.of("time"))
    assert went == pytest.approx(speed, rel=0.2)
    assert went > 1.2 * np.ptp(before[:, 2])
    tab.keep("journey-02-faster")


def share_of_standing(tab: Any, foot: int) -> float:
    """Return for which share of six cycles a foot is seen to stand."""
    cycle = 1.0 / tab.ask("polypod.frame.focus.cycleRate")
    walk = Walk(tab).wait(6.0 * cycle)
    whole = walk.of("time") < walk.of("time")[0] + 6.0 * cycle
    return float(walk.of("stance")[whole, foot].mean())


def drag_a_sectors_end(tab: Any) -> None:
    tab.open_panel("Gait")
    extent = in_use(tab, FOOT)[1]
    before = share_of_standing(tab, FOOT)
    turn_handle(tab, FOOT, "swing finish", -0.4 * extent)
    tab.until(lambda: tab.document["gait"], "the gait is drawn by hand")
    wanted = pytest.approx(0.6 * extent, abs=0.02)
    tab.until(lambda: in_use(tab, FOOT)[1] == wanted, "the foot's disk is as it was drawn")
    after = share_of_standing(tab, FOOT)
    # At least: a foot that is due may wait for its turn.
    assert after - before > 0.2 * extent, "it stands longer"
    tab.keep("journey-03-sector")


# How far to the left of the body and ahead of it a foot would like to stand, m.
PREFERRED = """
(k) => {
  const { focus, herds } = polypod.frame;
  const [x, , z] = focus.feet[k].preferred;
  const body = herds[focus.kind].body;
  const [sine, cosine] = [Math.sin(focus.heading), Math.cos(focus.heading)];
  return [(x - body[4]) * cosine - (z - body[6]) * sine,
    (x - body[4]) * sine + (z - body[6]) * cosine];
}
"""


def drag_a_foot(tab: Any) -> None:
    tab.open_panel("Feet")
    place = tab.page.get_by_role("button", name=f"{name_of(tab, FOOT)} place:")
    rest = tab.ask(f"polypod.creature.feet[{FOOT}].rest[0]")
    drag_by(tab, place, -20.0 if rest > 0.0 else 20.0, 0.0)
    tab.until(lambda: tab.document["spacing"], "the foot is placed")
    shift = tab.document["spacing"][FOOT][0]
    assert shift * rest > 0.0, "it is farther out"
    tab.until(
        lambda: abs(tab.page.evaluate(PREFERRED, FOOT)[0] - rest - shift) < 0.1 * abs(shift),
        "the foot would like to stand there",
    )
    tab.keep("journey-04-foot")


def own_rig(shared_rig: Any) -> tuple[str, bytes]:
    """Return a rig from a stranger, or, where there is none, one of the built-in creatures."""
    try:
        return "Fox.glb", shared_rig("khronos_fox/Fox.glb").read_bytes()
    except pytest.skip.Exception as missing:
        print(f"{missing}; the built-in wolf is dropped on the page instead")
        return "wolf.glb", build("wolf").glb


def walk_ones_own(tab: Any, rig: tuple[str, bytes]) -> None:
    drop_file(tab, *rig)
    verdict = tab.page.locator(".verdict")
    tab.until(lambda: "It can walk: 4 legs" in verdict.text_content(), "it is judged")
    tab.keep("journey-05-dropped")
    shrink = tab.page.get_by_role("button", name="In centimetres?")
    if shrink.is_visible():
        shrink.click()
        tab.until(lambda: "79.0 cm" in verdict.text_content(), "it is as tall as a fox")
    tab.until(tab.button("Walk it").is_enabled, "it may walk")
    tab.button("Walk it").click()
    tab.until(lambda: tab.ask("polypod.creature.feet.length") == 4, "it is there", LONG)
    assert tab.ask("polypod.creature.body.height") < 2.0
    tab.until(lambda: tab.ask("polypod.frame.focus.speed") > 0.2, "it walks", LONG)
    walk = Walk(tab).wait(1.0).of("body")
    assert np.ptp(walk[:, 2]) > 0.2, "it goes ahead"
    tab.keep("journey-06-own-rig")


def step_on_a_crate(tab: Any, folder: Path) -> None:
    tab.open_panel("World")
    tab.leave()
    tab.page.keyboard.press(" ")
    tab.until(lambda: not tab.ask("polypod.clock.playing"), "time stands")
    tab.button("Add a box").click()
    tab.until(lambda: tab.document["obstacle"], "a crate is there")
    crate = tab.document["obstacle"][0]
    place, size = np.array(crate["position"]), np.array(crate["size"])
    tab.until(lambda: in_view(tab, place), "it is in the picture")
    tab.page.wait_for_timeout(1000)
    tab.keep("journey-07-crate-added")
    assert abs(place[0] - centre(tab)[0]) < 0.5 * size[0], "it is in its way"
    tab.leave()
    tab.page.keyboard.press("r")
    tab.until(lambda: tab.ask("polypod.tape.recording"), "it is recorded")
    tab.page.keyboard.press(" ")
    tab.until(lambda: centre(tab)[2] > place[2], "it is at the crate", LONG)
    tab.keep("journey-08-crate")
    past = place[2] + size[2] + tab.ask("polypod.creature.leg_length")
    tab.until(lambda: centre(tab)[2] > past, "it is past the crate", LONG)
    tab.page.keyboard.press("r")
    tab.until(lambda: not tab.ask("polypod.tape.recording"), "it is recorded no more")
    tab.open_panel("Record")
    record = recorded(tab, folder / "crate.npz")
    off = np.abs(record.foot_position - place) - 0.5 * size
    assert off.max(axis=2).min() > -0.002, "no foot is inside the crate"
    stepped = (record.foot_support == 0).any()
    aside = np.abs(record.body_position[:, 0] - place[0]).max()
    assert stepped or aside > 0.5 * size[0], "it steps on the crate or goes round it"


def in_view(tab: Any, place: np.ndarray) -> bool:
    """Whether a place of the world is in the picture."""
    box = tab.page.get_by_role("application").bounding_box()
    x, y = pixels(tab, place)
    return bool(0.0 < x - box["x"] < box["width"] and 0.0 < y - box["y"] < box["height"])


def recorded(tab: Any, file: Path) -> Record:
    """Return what was recorded, by the page's own button."""
    _, data = tab.download(tab.button("NPZ, the record as numbers").click)
    file.write_bytes(data)
    return read_record(file)


def push_it(tab: Any) -> None:
    tab.open_panel("Body")
    leg = tab.ask("polypod.creature.leg_length")
    line = np.median(Walk(tab).wait(1.5).of("body")[:, 0])
    walk = Walk(tab)
    here = centre(tab)
    begin, end = pixels(tab, here), pixels(tab, here + np.array([1.2 * leg, 0.0, 0.0]))
    mouse = tab.page.mouse
    mouse.move(*begin)
    mouse.down()
    mouse.move(*end, steps=6)
    tab.page.wait_for_timeout(700)
    tab.keep("journey-09-pushing")
    mouse.up()
    aside = f"polypod.frame.herds[0].body[4] - {line} > {0.1 * leg}"
    tab.until(lambda: tab.ask(aside), "it is thrown off its line")
    tab.keep("journey-10-pushed")
    off = np.abs(walk.wait(7.0).of("body")[:, 0] - line)
    assert off.max() > 0.1 * leg
    assert off[-20:].max() < 0.3 * off.max(), "it comes back to its line"
    tab.keep("journey-11-back")


def blend_to_a_trot(tab: Any) -> None:
    tab.open_panel("Gait")
    tab.type_into("Blend in in cycles", "3")
    tab.until(lambda: tab.document["command"]["blend_cycles"] == 3.0, "it blends in 3 cycles")
    choice = tab.page.get_by_role("combobox", name="Gait")
    choice.select_option("walk")
    tab.until(lambda: near(behind_the_first(tab), 0.25), "no two feet lift at once", LONG)
    tab.keep("journey-12-walk")
    walk = Walk(tab)
    choice.select_option("trot")
    tab.until(lambda: near(behind_the_first(tab), 0.5), "feet lift in two pairs", LONG)
    tab.keep("journey-13-trot")
    walk.wait(1.0)
    extent = walk.of("extent")[:, 0]
    least, most = sorted(extent[[0, -1]])
    between = (extent > least + 0.01) & (extent < most - 0.01)
    assert between.sum() > 5, "the disks go from one to the other little by little"


def behind_the_first(tab: Any) -> np.ndarray:
    """Return how much later than the first foot each lifts, cycles."""
    start = np.array([in_use(tab, foot)[0] for foot in range(4)])
    return np.mod(start - start[0], 1.0)


def near(later: np.ndarray, part: float) -> bool:
    """Whether the feet lift in equal parts of the cycle, and in each part equally many."""
    whole = later / part
    counts = np.bincount(np.round(whole).astype(int) % round(1.0 / part))
    return bool(np.abs(whole - np.round(whole)).max() < 0.08) and len(set(counts)) == 1


def take_it_away(tab: Any, folder: Path) -> None:
    tab.open_panel("Record")
    tab.ask("window.seen.length = 0")
    tab.button("● Record").click()
    # The tape before may be as long.
    long = "polypod.tape.recording && polypod.tape.seconds >= 5"
    tab.until(lambda: tab.ask(long), "5 s are recorded", LONG)
    tab.button("■ Stop").click()
    glb = tab.button("GLB, the rig with this motion")
    tab.until(glb.is_enabled, "it can be exported")
    tab.keep("journey-14-recorded")
    name, data = tab.download(glb.click)
    assert name.endswith(".glb")
    record = recorded(tab, folder / "walk.npz")
    assert record.time[-1] >= 5.0
    played = Playback(GltfDocument.from_bytes(data, name))
    assert played.end == pytest.approx(record.time[-1], abs=1e-5)
    assert np.ptp(record.body_position[:, 2]) > 2.0, "there is a walk to compare"
    tolerance = 1e-5 * np.abs(record.joint_position).max()
    motion = played.world_matrices(record.time)[..., :3, 3][:, record.joint_node]
    assert np.abs(motion - record.joint_position).max() < tolerance, "the GLB is the record"

    # What the page showed while it was recorded, and what it shows of the tape.
    tab.slider("Recorded time").press("Home")
    tab.until(lambda: tab.ask("polypod.frame.tapeFrame") == 0, "the tape's begin is shown")
    began = tab.ask("polypod.frame.time")
    kept = "seen.filter((one) => one.pose)"
    time = np.array(tab.ask(f"{kept}.map((one) => one.time)")) - began
    pose = np.array(tab.ask(f"{kept}.map((one) => one.pose)"))
    inside = (time >= 0.0) & (time <= record.time[-1])
    assert inside.sum() > 30
    assert differs(tab, played, record, time[inside], pose[inside]) < tolerance
    tab.slider("Recorded time").press("End")
    last = len(record.time) - 1
    tab.until(lambda: tab.ask("polypod.frame.tapeFrame") == last, "the tape's end is shown")
    tab.keep("journey-15-scrubbed")
    pose = np.array([tab.ask("Array.from(polypod.frame.herds[0].pose)")])
    assert differs(tab, played, record, record.time[-1:], pose) < tolerance


def differs(
    tab: Any, played: Playback, record: Record, time: np.ndarray, pose: np.ndarray
) -> float:
    """Return how far apart the joints of a GLB and of frames [F, 7 joints] are at most, m."""
    rest = np.array(tab.ask("polypod.creature.rest"))
    pose = pose.reshape(len(time), -1, 7)[:, : len(rest)]  # without the body, which is the last
    shown = np.array([rotate_all(one[:, :4], rest) for one in pose]) + pose[..., 4:]
    motion = played.world_matrices(time)[..., :3, 3][:, record.joint_node]
    return float(np.abs(motion - shown).max())
