"""Building the world as a person does: meshes dropped, scenes with their files, sizes, views."""

from __future__ import annotations

import io
import json
import tomllib
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hands import beside, centre, drag, drop_file, drop_files, pixels

BENCH = Path(__file__).parents[2] / "examples" / "scenes" / "bench.obj"
SCENE = """
[terrain]
heightmap = "hills.npy"
cell = 0.5
origin = [-10.0, -10.0]
[[obstacle]]
name = "seat"
shape = "mesh"
file = "bench.obj"
position = [1.0, 0.2, 2.0]
"""
DISTANCE = "polypod.scene.cameras.camera.position.distanceTo(polypod.scene.cameras.controls.target)"
# How high the ground is over the line from the eye to each of some places about the body.
HIDDEN = """
(() => {
  const { cameras, creatures, ground } = polypod.scene;
  const eye = cameras.camera.position, body = cameras.centre;
  let over = -Infinity;
  for (let share = 0; share < 0.985; share += 0.002) {
    const at = eye.clone().lerp(body, share);
    over = Math.max(over, ground.relief.height(at.x, at.z) - at.y);
  }
  return over;
})()
"""


def pause(tab: Any) -> None:
    tab.ask("polypod.send({do: 'clock', playing: false})")
    tab.until(lambda: not tab.ask("polypod.clock.playing"), "time stands")


def hills() -> bytes:
    held = io.BytesIO()
    along = np.linspace(0.0, 12.0, 41)
    np.save(held, 0.05 * np.sin(along)[:, None] * np.cos(along)[None])
    return held.getvalue()


def test_a_mesh_is_dropped_walked_on_saved_and_opened_again(tab: Any) -> None:
    tab.open_panel("Feet")
    drop_file(tab, "bench.obj", BENCH.read_bytes())
    tab.until(lambda: len(tab.document["obstacle"]) == 1, "the bench stands there")
    assert "convex parts" in tab.words
    bench = tab.document["obstacle"][0]
    assert bench["size"] == pytest.approx([1.2, 0.12, 0.3])
    assert bench["position"][1] == pytest.approx(0.06)
    shown = "polypod.scene.obstacles.meshes[0].geometry.attributes.position?.count ?? 0"
    tab.until(lambda: tab.ask(shown) > 36, "its own surface is drawn")
    # In its way, and as wide as a stage.
    here = centre(tab)
    placed = {**bench, "size": [3.0, 0.1, 2.0], "position": [here[0], 0.05, here[2] + 1.6]}
    tab.ask(f"polypod.edit(['obstacle', 0], {json.dumps(placed)})")
    on_it = "polypod.frame.focus.feet.filter((foot) => Math.abs(foot.sole[1] - 0.1) < 0.005).length"
    tab.until(lambda: tab.ask(on_it) >= 4, "feet stand on it", 60.0)
    tab.open_panel("World")
    assert tab.page.get_by_text("bench.obj").first.is_visible()
    tab.keep("world-mesh")
    name, saved = tab.download(tab.button("Save scene").click)
    assert name == "scene.zip"
    with zipfile.ZipFile(io.BytesIO(saved)) as archive:
        assert sorted(archive.namelist()) == ["bench.obj", "scene.toml"]
        scene = tomllib.loads(archive.read("scene.toml").decode())
    assert scene["obstacle"][0]["file"] == "bench.obj"
    wanted = tab.document["obstacle"]
    tab.button("Delete all").click()
    tab.until(lambda: tab.document["obstacle"] == [], "it is gone")
    drop_file(tab, "mine.zip", saved)
    tab.until(lambda: tab.document["obstacle"] == wanted, "the zip brings it back")


def test_a_scene_says_what_it_wants_and_takes_it(tab: Any) -> None:
    drop_file(tab, "valley.toml", SCENE.encode())
    tab.until(
        lambda: "hills.npy" in tab.words and "bench.obj" in tab.words, "it says what it wants"
    )
    assert tab.document["obstacle"] == []
    drop_files(tab, {"bench.obj": BENCH.read_bytes(), "hills.npy": hills()})
    tab.until(lambda: tab.document["terrain"] == {"given": "valley"}, "it is open")
    assert tab.document["obstacle"][0]["name"] == "seat"
    tab.open_panel("World")
    choice = tab.page.get_by_role("combobox", name="Ground", exact=True)
    assert choice.input_value() == "given valley"
    tab.keep("world-scene-with-files")
    # All at once, and what is no mesh is refused with a word.
    tab.ask("polypod.edit(['terrain'], null)")
    drop_files(
        tab,
        {"hills.npy": hills(), "valley.toml": SCENE.encode(), "bench.obj": BENCH.read_bytes()},
    )
    tab.until(lambda: tab.document["terrain"] == {"given": "valley-2"}, "it is open again")
    drop_file(tab, "flat.obj", b"v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3")
    tab.until(lambda: "flat" in tab.words, "a flat mesh is refused")


HULL = {
    "shape": "hull", "points": [[0, 0, 0], [0.2, 0, 0], [0, 0, 0.2], [0.2, 0, 0.2], [0, 0.1, 0],
                                [0.2, 0.1, 0], [0, 0.1, 0.2], [0.2, 0.1, 0.2]],
}  # fmt: skip


@pytest.mark.parametrize(
    "shape",
    [
        HULL,
        {"shape": "cylinder", "size": [0.2, 0.1, 0.2]},
        {"shape": "sphere", "size": [0.2, 0.2, 0.2]},
        {"shape": "mesh", "size": [0.2, 0.1, 0.2]},
    ],
    ids=lambda shape: shape["shape"],
)
def test_each_kind_of_obstacle_is_resized_by_hand_and_by_number(
    tab: Any, shape: dict[str, Any]
) -> None:
    pause(tab)
    if shape["shape"] == "mesh":
        drop_file(tab, "bench.obj", BENCH.read_bytes())
        tab.until(lambda: tab.document["obstacle"], "the mesh is there")
        shape = {**shape, "file": tab.document["obstacle"][0]["file"]}
    here = centre(tab)
    values = {**shape, "position": [here[0] + 0.5, 0.05, here[2] + 0.2], "yaw": 0.0}
    tab.ask(f"polypod.edit(['obstacle'], [{json.dumps(values)}])")
    tab.until(lambda: tab.document["obstacle"][0]["position"] == values["position"], "it is there")
    tab.until_drawn()
    tab.ask("polypod.scene.select(0)")
    tab.page.wait_for_timeout(400)
    measured = "(() => { const h = polypod.scene.handles; h.measure(h.mesh);"
    corners = np.array(tab.ask(measured + "return Array.from(h.corners); })()")).reshape(8, 3)
    drag(tab, pixels(tab, corners[7]), pixels(tab, beside(corners[7], 0.1, 0.0, 0.1)))
    extent = measured + "const c = h.corners; return [0, 1, 2].map((a) => c[21 + a] - c[a]); })()"

    def wide() -> bool:
        x, _, z = tab.ask(extent)
        return x == pytest.approx(0.3, abs=0.03) and z == pytest.approx(0.3, abs=0.03)

    tab.until(wide, "it is wider")
    stays = pytest.approx(corners[0, [0, 2]], abs=1e-3)
    opposite = measured + "return [h.corners[0], h.corners[2]]; })()"
    tab.until(lambda: tab.ask(opposite) == stays, "the opposite corner stays")
    tab.open_panel("World")
    tab.type_into("Size y in m", "0.25")
    tab.until(lambda: tab.ask(extent)[1] == pytest.approx(0.25, abs=1e-3), "it is as high as typed")
    tab.button("Undo").click()
    tab.until(lambda: tab.ask(extent)[1] < 0.249 or shape["shape"] == "sphere", "undo")
    assert tab.words == "" or "stands here" in tab.words


def test_a_record_goes_on_while_the_world_is_built(tab: Any) -> None:
    tab.ask("polypod.send({do: 'record', on: true})")
    tab.until(lambda: tab.ask("polypod.tape.frames") > 20, "it is recorded")
    tab.open_panel("World")
    tab.button("Add a box").click()
    tab.until(lambda: tab.document["obstacle"], "a box is there")
    came = tab.ask("polypod.tape.frames")
    tab.until(lambda: tab.ask("polypod.tape.frames") > came + 30, "the record goes on")
    tab.ask("polypod.edit(['terrain'], {generator: 'stairs'})")
    tab.until(lambda: tab.document["terrain"], "there are stairs")
    changed = tab.ask("polypod.tape.frames")
    tab.until(lambda: tab.ask("polypod.tape.frames") > changed + 30, "the record goes on")
    assert tab.ask("polypod.tape.recording")
    tab.ask("polypod.send({do: 'record', on: false})")
    # The tape shows the world as it was.
    meshes = "polypod.scene.obstacles.meshes.length"
    ground = "polypod.scene.ground.number"
    tab.until(lambda: not tab.ask("polypod.tape.recording"), "it has ended")
    last = tab.ask("polypod.tape.frames") - 1
    now = tab.ask(ground)
    tab.ask("polypod.send({do: 'scrub', frame: 5})")
    tab.until(lambda: tab.ask(meshes) == 0, "no box stood yet")
    tab.until(lambda: tab.ask(ground) != now, "nor stairs")
    tab.ask(f"polypod.send({{do: 'scrub', frame: {last}}})")
    tab.until(lambda: tab.ask(meshes) == 1 and tab.ask(ground) == now, "then they did")
    tab.open_panel("Record")
    _, data = tab.download(tab.button("NPZ, the record as numbers").click)
    with np.load(io.BytesIO(data), allow_pickle=False) as record:
        there = record["obstacle_there"]
        assert there.shape == record["obstacle_position"].shape[:2]
        assert not there[0].any()
        assert there[-1].all()
    tab.ask("polypod.send({do: 'scrub', frame: null})")


@pytest.mark.parametrize("view", ["side", "front"])
def test_no_hill_hides_the_creature_from_a_side(tab: Any, view: str) -> None:
    tab.ask("polypod.edit(['terrain'], {generator: 'hills', relief: 1.2, wavelength: 3.0})")
    tab.page.get_by_label("Camera").select_option(view)
    tab.until(lambda: tab.ask("polypod.scene.ground.relief.highest") > 0.2, "there are hills")
    lifts = []
    for _ in range(4):
        tab.page.wait_for_timeout(2000)
        lifts.append(tab.ask("polypod.scene.cameras.lift"))
        assert tab.ask(HIDDEN) < 0.0
    assert max(lifts) > 0.08
    tab.keep(f"world-hills-{view}")
    # On level ground it is down again.
    tab.ask("polypod.edit(['terrain'], null)")
    tab.until(lambda: tab.ask("polypod.scene.cameras.lift") < 0.065, "it is from the side again")
    tab.page.get_by_label("Camera").select_option("follow")


def test_a_new_crate_is_seen_and_the_view_comes_back(tab: Any) -> None:
    tab.button("Frame").click()
    tab.page.wait_for_timeout(800)
    before = tab.ask(DISTANCE)
    tab.open_panel("World")
    tab.button("Add a box").click()
    tab.until(lambda: tab.document["obstacle"], "a box is there")
    place = tab.document["obstacle"][0]["position"]
    tab.until(lambda: tab.page.evaluate("(p) => polypod.scene.sees(p, 1)", place), "it is seen")
    back = pytest.approx(before, rel=0.05)
    tab.ask("polypod.scene.select(null)")
    tab.until(lambda: tab.ask(DISTANCE) == back, "the view is where it was")
    # What is seen anyway moves nothing.
    tab.page.evaluate("(p) => polypod.scene.reveal(p)", centre(tab).tolist())
    tab.page.wait_for_timeout(800)
    assert tab.ask(DISTANCE) == back
    # One far off has the view go back, until it is let go.
    tab.ask("polypod.scene.select(0)")
    here = centre(tab)
    far = [here[0] + 4.0, 0.0, here[2] + 4.0]
    tab.page.evaluate("(p) => polypod.scene.reveal(p)", far)
    tab.until(lambda: tab.ask(DISTANCE) > 1.5 * before, "the view goes back")
    tab.ask("polypod.scene.select(null)")
    tab.until(lambda: tab.ask(DISTANCE) == back, "and comes back")


def test_candidates_are_ringed_in_their_foots_colour(tab: Any) -> None:
    tab.ask("polypod.edit(['terrain'], {generator: 'rocks', height: 0.2, share: 0.7})")
    tab.page.get_by_role("button", name="Overlays").click()
    tab.page.get_by_role("checkbox", name="Candidate footprints").check()
    tab.page.keyboard.press("Escape")
    tab.ask(
        """(() => { window.feet = new Set(); polypod.on("arrays", ({ name, arrays }) => {
          if (name !== "candidates") return;
          const { rows, count, stride } = polypod.scene.overlays.plan.candidates;
          for (let i = 0; i < arrays.foot.data.length; i++) {
            const hex = polypod.creature.feet[arrays.foot.data[i]].colour;
            const wanted = [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16) / 255);
            const ring = Array.from(rows.slice(4 * stride * i + 5, 4 * stride * i + 8));
            if (count !== 2 * arrays.foot.data.length) window.feet.add("a ring is missing");
            if (Math.hypot(...ring.map((v, a) => v - wanted[a])) > 0.01) window.feet.add(`${ring}`);
            else window.feet.add(arrays.foot.data[i]);
          }
        }); })()"""
    )
    tab.until(lambda: tab.ask("window.feet.size") >= 6, "candidates of many feet")
    assert all(isinstance(foot, int) for foot in tab.ask("[...window.feet]"))
    tab.page.get_by_label("Camera").select_option("top")
    tab.page.wait_for_timeout(1500)
    pause(tab)
    tab.page.wait_for_timeout(800)
    tab.keep("world-candidates")
    tab.page.get_by_label("Camera").select_option("follow")
