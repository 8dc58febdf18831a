"""The scene as a person uses it: clicks, drags, cameras, overlays, and the bar above it."""

from __future__ import annotations

import base64
import io
import json
import math
from typing import Any

import numpy as np
import pytest
from hands import beside, centre, drag, pixels

CRATE = {
    "name": "crate", "shape": "box", "size": [0.16, 0.08, 0.2], "position": [0.5, 0.04, 0.0],
    "yaw": 0.0, "forbidden": False,
}  # fmt: skip
# How many pieces of an overlay are in the picture.
PIECES = """(parts) => parts.reduce((sum, path) => {
  const part = path.split(".").reduce((at, name) => at[name], polypod.scene.overlays);
  return sum + part.count;
}, 0)"""
PARTS = {
    "Way to go": ["body.lines"],
    "Foot targets": ["body.marks"],
    "Foot paths, 2D and 3D": ["plan.flat", "plan.space"],
    "Candidate footprints": ["plan.candidates"],
    "Map cells": ["plan.cells"],
    "Body trajectory": ["body.trailLines"],
    "Support hull": ["plan.hull"],
    "Pelvis nodes and spine": ["body.inside.nodes"],
    "Joint limits": ["body.inside.fans"],
    "Bones": ["body.inside.bones"],
}


def pause(tab: Any) -> None:
    tab.ask("polypod.send({do: 'clock', playing: false})")
    tab.until(lambda: not tab.ask("polypod.clock.playing"), "time stands")
    # What is shown is what the last frame says.
    tab.until(
        lambda: tab.ask("polypod.scene.playback.to?.time === polypod.frame.time"), "it is shown"
    )
    # From a little further away there is ground to click on.
    tab.page.mouse.move(450, 300)
    for _ in range(2):
        tab.page.mouse.wheel(0, 400)
    tab.page.mouse.move(20, 300)
    tab.until_drawn()


def with_crate(tab: Any) -> dict[str, Any]:
    """Put a crate beside the creature and return it, drawn."""
    pause(tab)
    here = centre(tab)
    crate = {**CRATE, "position": [here[0] + 0.5, 0.04, here[2] + 0.3]}
    tab.ask(f"polypod.edit(['obstacle', 0], {json.dumps(crate)})")
    tab.until(lambda: tab.ask("polypod.frame.obstacles.length") == 7, "the crate is there")
    tab.until_drawn()
    return crate


def picture(tab: Any) -> Any:
    """Return the picture that can be saved, as an image."""
    from PIL import Image

    text = tab.ask(
        """polypod.scene.picture().then((blob) => new Promise((resolve) => {
          const reader = new FileReader();
          reader.onload = () => resolve(reader.result.split(",")[1]);
          reader.readAsDataURL(blob);
        }))"""
    )
    return Image.open(io.BytesIO(base64.b64decode(text))).convert("RGB")


def test_a_click_on_the_ground_sends_it_there_and_shift_adds_a_place(tab: Any) -> None:
    pause(tab)
    here = centre(tab)
    first, second = beside(here, 0.6, -here[1], 0.3), beside(here, -0.6, -here[1], 0.4)
    tab.page.mouse.click(*pixels(tab, first))
    tab.until(lambda: len(tab.document["path"]) == 1, "it has a goal")
    assert tab.document["path"][0] == pytest.approx([first[0], first[2]], abs=0.01)
    tab.page.keyboard.down("Shift")
    tab.page.mouse.click(*pixels(tab, second))
    tab.page.keyboard.up("Shift")
    tab.until(lambda: len(tab.document["path"]) == 2, "it has a second goal")
    assert tab.document["path"][1] == pytest.approx([second[0], second[2]], abs=0.01)
    tab.keep("scene-goals")
    tab.button("Play").click()
    tab.until(lambda: np.hypot(*(centre(tab) - first)[[0, 2]]) < 0.3, "it comes to the first place")


def test_a_drag_on_the_ground_turns_the_view_and_orders_nothing(tab: Any) -> None:
    pause(tab)
    here = centre(tab)
    begin = pixels(tab, beside(here, 0.7, -here[1], 0.2))
    before = tab.ask("polypod.scene.cameras.camera.position.toArray()")
    drag(tab, begin, (begin[0] - 120, begin[1] - 10))
    after = tab.ask("polypod.scene.cameras.camera.position.toArray()")
    assert math.dist(before, after) > 0.2
    assert tab.document["path"] == []


def test_a_drag_on_the_body_pushes_it(tab: Any) -> None:
    tab.until(lambda: tab.ask("polypod.frame.time") > 2, "it walks")
    pause(tab)
    here = centre(tab)
    orders = "(() => { const send = polypod.send.bind(polypod); window.sent = [];"
    orders += "polypod.send = (order) => { window.sent.push(order); return send(order); }; })()"
    tab.ask(orders)
    begin = pixels(tab, here)
    end = pixels(tab, beside(here, 0.4, 0.0, 0.0))
    tab.page.mouse.move(*begin)
    tab.page.mouse.down()
    tab.page.mouse.move(*end, steps=5)
    tab.until_drawn()
    tab.keep("scene-push")
    tab.page.mouse.up()
    (push,) = [order for order in tab.ask("window.sent") if order["do"] == "push"]
    assert push["creature"] == 0
    assert push["velocity"][0] > 0.1
    assert abs(push["velocity"][1]) < 1e-6
    assert abs(push["velocity"][2]) < 0.5 * push["velocity"][0]
    tab.button("Play").click()
    # It walked along +z: only the push leads it aside.
    tab.until(lambda: centre(tab)[0] - here[0] > 0.02, "it is pushed to its left")


def test_a_crate_is_chosen_moved_turned_resized_and_deleted(tab: Any) -> None:
    crate = with_crate(tab)
    place = np.array(crate["position"])
    tab.page.mouse.click(*pixels(tab, beside(place, 0.03, 0.04, 0.03)))
    tab.until(lambda: tab.ask("polypod.scene.handles.index") == 0, "the crate is chosen")
    grip = beside(place, -0.04, 0.04, 0.05)
    drag(tab, pixels(tab, grip), pixels(tab, beside(grip, 0.2, 0.0, 0.1)))

    def position() -> list[float]:
        return tab.document["obstacle"][0]["position"]

    goal = pytest.approx(beside(place, 0.2, 0.0, 0.1), abs=0.02)
    tab.until(lambda: position() == goal, "the crate is moved")
    tab.keep("scene-crate")
    tab.button("Undo").click()
    tab.until(lambda: position() == pytest.approx(place), "one undo takes the drag back")

    tab.page.wait_for_timeout(400)
    measured = "(() => { const h = polypod.scene.handles; h.measure(h.mesh);"
    ring = measured + "return [0.9, 1.7].map((a) => h.ringPlace(h.place, a).toArray()); })()"
    begin, end = tab.ask(ring)
    drag(tab, pixels(tab, begin), pixels(tab, end))
    tab.until(
        lambda: tab.document["obstacle"][0]["yaw"] == pytest.approx(0.8, abs=0.1),
        "the crate is turned",
    )
    tab.button("Undo").click()
    tab.until(lambda: tab.document["obstacle"][0]["yaw"] == 0.0, "it is turned back")

    tab.page.wait_for_timeout(400)
    corner = np.array(
        tab.ask(measured + "return Array.from(h.corners.slice(21, 24)); })()")
    )  # +x, +y, +z
    drag(tab, pixels(tab, corner), pixels(tab, beside(corner, 0.1, 0.0, 0.05)))
    larger = pytest.approx([0.26, 0.08, 0.25], abs=0.02)
    tab.until(lambda: tab.document["obstacle"][0]["size"] == larger, "the crate is larger")
    size, moved = tab.document["obstacle"][0]["size"], position()
    # The opposite corner stays.
    assert moved[0] - size[0] / 2 == pytest.approx(place[0] - 0.08, abs=1e-4)
    assert moved[2] - size[2] / 2 == pytest.approx(place[2] - 0.10, abs=1e-4)

    tab.page.keyboard.press("Delete")
    tab.until(lambda: tab.document["obstacle"] == [], "the crate is gone")
    assert tab.ask("polypod.scene.handles.index") is None


def test_a_way_is_drawn_and_becomes_a_path_of_few_places(tab: Any) -> None:
    pause(tab)
    here = centre(tab)
    tab.button("Draw a path").click()
    line = [beside(here, 0.5 * math.sin(0.35 * i), -here[1], -0.3 + 0.07 * i) for i in range(14)]
    tab.page.mouse.move(*pixels(tab, line[0]))
    tab.page.mouse.down()
    for place in line[1:]:
        tab.page.mouse.move(*pixels(tab, place), steps=2)
    tab.page.mouse.up()
    path = np.array(tab.until(lambda: tab.document["path"], "there is a path"))
    assert 3 <= len(path) < len(line)
    assert path[0] == pytest.approx(line[0][[0, 2]], abs=0.03)
    assert path[-1] == pytest.approx(line[-1][[0, 2]], abs=0.1)
    for place in path:
        assert min(math.dist(place, other[[0, 2]]) for other in line) < 0.12
    tab.keep("scene-path")


def test_the_skin_is_drawn_where_the_pose_is(tab: Any) -> None:
    pause(tab)
    image = picture(tab)
    frame = tab.ask("polypod.scene.canvas.getBoundingClientRect().toJSON()")
    scale = image.width / frame["width"]
    abdomen = tab.ask(
        """(() => { const { herd, row } = polypod.scene.creatures.focus(polypod.frame);
        const out = new Float32Array(3);
        polypod.scene.overlays.body.inside.joint(out, { herd, row }, polypod.creature, 1);
        return Array.from(out); })()"""
    )
    here = centre(tab)

    def colour(place: Any) -> np.ndarray:
        x, y = pixels(tab, place)
        spot = (round((x - frame["x"]) * scale), round((y - frame["y"]) * scale))
        return np.array(image.getpixel(spot), float)

    ground = colour(beside(here, 0.6, -here[1], 0.0))
    assert np.ptp(ground) < 30  # grey
    # The spider's trunk is dark brown.
    for place in (here, abdomen):
        assert colour(place).mean() < 0.75 * ground.mean()


def test_side_views_are_from_the_side_and_the_view_follows(tab: Any) -> None:
    views = {"side": [1.0, 0.0], "front": [0.0, 1.0]}
    for name, (left, ahead) in views.items():
        tab.page.get_by_label("Camera").select_option(name)

        def off(left: float = left, ahead: float = ahead) -> float:
            eye, target, heading = tab.ask(
                """(() => { const c = polypod.scene.cameras; return [c.camera.position.toArray(),
                c.controls.target.toArray(), c.heading]; })()"""
            )
            away = np.array(eye) - np.array(target)
            sine, cosine = math.sin(heading), math.cos(heading)
            way = np.array([cosine * left + sine * ahead, cosine * ahead - sine * left])
            return 1.0 - away[[0, 2]] @ way / np.hypot(away[0], away[2])

        tab.until(lambda off=off: off() < 0.001, f"it is seen from the {name}")
        tab.keep(f"scene-{name}")
    tab.page.get_by_label("Camera").select_option("follow")
    tab.page.wait_for_timeout(500)
    offset = "polypod.scene.cameras.camera.position.clone().sub(polypod.scene.cameras.centre)"
    before, here = np.array(tab.ask(f"{offset}.toArray()")), centre(tab)
    tab.until(lambda: math.dist(centre(tab), here) > 0.5, "it walks on")
    assert np.array(tab.ask(f"{offset}.toArray()")) == pytest.approx(before, abs=0.1)


def test_frame_shows_the_whole_creature(tab: Any) -> None:
    tab.until(lambda: tab.ask("polypod.scene.drawn") > 2, "it is drawn")
    x, y = pixels(tab, centre(tab))
    tab.page.mouse.move(x, y)
    for _ in range(6):
        tab.page.mouse.wheel(0, 600)
    apparent = "polypod.scene.cameras.apparent() / polypod.scene.cameras.size"
    tab.until(lambda: tab.ask(apparent) > 4, "it is far away")
    tab.button("Frame").click()
    tab.until(lambda: 2 < tab.ask(apparent) < 3.5, "it fills the picture")


def test_each_overlay_has_a_switch_that_is_remembered(tab: Any) -> None:
    here = centre(tab)
    # So far away that it walks all the while.
    tab.ask(f"polypod.edit(['path'], [[{here[0]}, {here[2] + 60.0}]])")
    for title, parts in PARTS.items():
        tab.page.get_by_role("button", name="Overlays").click()
        switch = tab.page.get_by_role("checkbox", name=title)
        for on in (False, True):
            switch.set_checked(on)
            tab.until(
                lambda on=on, parts=parts: (
                    (tab.page.evaluate(PIECES, parts) > 0) == on
                    # Way and targets share their lines and marks.
                    or (not on and parts[0] in ("body.lines", "body.marks"))
                ),
                f"{title} is {'there' if on else 'gone'}",
            )
        tab.page.keyboard.press("Escape")
    tab.keep("scene-overlays")
    tab.page.get_by_role("button", name="Overlays").click()
    tab.page.get_by_role("checkbox", name="Map cells").set_checked(False)
    tab.page.reload()
    tab.until(lambda: tab.ask("Boolean(window.polypod?.frame && polypod.creature)"), "it is back")
    tab.page.get_by_role("button", name="Overlays").click()
    assert not tab.page.get_by_role("checkbox", name="Map cells").is_checked()
    assert tab.page.get_by_role("checkbox", name="Bones").is_checked()
    tab.until(lambda: tab.page.evaluate(PIECES, ["plan.hull"]) > 0, "the hull is asked for again")


def test_time_is_paused_stepped_and_slowed(tab: Any) -> None:
    tab.button("Pause").click()
    tab.until(lambda: not tab.ask("polypod.clock.playing"), "time stands")
    time = tab.until(lambda: tab.ask("polypod.frame.time"), "there is a frame")
    tab.button("Step").click()
    tab.until(lambda: tab.ask("polypod.frame.time") > time, "a frame has passed")
    tab.page.wait_for_timeout(500)
    assert tab.ask("polypod.frame.time") == pytest.approx(time + 1 / 60, abs=1e-6)
    tab.type_into("Time scale, times real time", "0.25")
    tab.until(lambda: tab.ask("polypod.clock.rate") == 0.25, "time is slow")
    tab.button("Time scale to real time").click()
    tab.until(lambda: tab.ask("polypod.clock.rate") == 1, "time is as real")


def test_a_second_tab_watches_until_it_takes_over(tab: Any, new_tab: Any) -> None:
    other = new_tab()
    assert other.button("Pause").is_disabled()
    other.button("Drive from here").click()
    other.until(lambda: other.ask("polypod.drives"), "it drives")
    tab.until(lambda: not tab.ask("polypod.drives"), "the first one watches")
    assert other.button("Pause").is_enabled()


def test_modules_that_draw_by_hand(tab: Any) -> None:
    # A cube's corners with its middle and a point of a side: twelve triangles, volume 1.
    volume, count = tab.ask(
        """import("/page/hull.js").then(({ hullTriangles }) => {
          const points = [[0.5, 0.5, 0.5], [0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [0, 0, 1],
            [1, 0, 1], [0, 1, 1], [1, 1, 1], [0.5, 0, 0.5]];
          const flat = hullTriangles(points);
          let volume = 0;
          for (let i = 0; i < flat.length; i += 9) {
            const [a, b, c, d, e, f, g, h, k] = flat.slice(i, i + 9);
            volume += (a * (e * k - f * h) - b * (d * k - f * g) + c * (d * h - e * g)) / 6;
          }
          return [volume, flat.length / 9];
        })"""
    )
    assert volume == pytest.approx(1.0)
    assert count == 12
    # A coarser skin has far fewer vertices and reaches as far.
    fine, coarse, reach, coarse_reach = tab.until(
        lambda: tab.ask(
            """import("/page/coarse.js").then(({ coarsened }) => {
              const herd = polypod.scene.creatures.herds[0];
              if (!herd.arrays) return null;
              const less = coarsened(herd.arrays, herd.radius);
              const most = ({ data }) => Math.max(...data.map(Math.abs));
              return [herd.arrays.place.shape[0], less.place.shape[0], most(herd.arrays.place),
                most(less.place)];
            })"""
        ),
        "the skin is there",
    )
    assert coarse < 0.4 * fine
    assert coarse_reach == pytest.approx(reach, rel=0.1)
    # A straight line is two places, a corner three.
    assert tab.ask(
        """import("/page/way.js").then(({ simplified }) => [
          simplified([[0, 0], [1, 0.01], [2, 0]], 0.1).length,
          simplified([[0, 0], [1, 1], [2, 0]], 0.1).length])"""
    ) == [2, 3]


# A ball whose triangles share no vertex, as skins with sharp edges have it, and how many edges of
# its coarse skin have a triangle on one side alone.
TORN = """
async () => {
  const { THREE } = await import("three");
  const { COARSE, CRUDE, coarsened } = await import("/page/coarse.js");
  const ball = new THREE.SphereGeometry(1, 48, 32).toNonIndexed();
  ball.computeVertexNormals();
  const count = ball.getAttribute("position").count;
  const given = (data, wide) => ({ data, shape: [count, wide] });
  const arrays = {
    place: given(ball.getAttribute("position").array, 3),
    normal: given(ball.getAttribute("normal").array, 3),
    joint: given(new Uint16Array(4 * count), 4),
    weight: given(Float32Array.from({ length: 4 * count }, (_, i) => (i % 4 ? 0 : 1)), 4),
    colour: given(new Uint8Array(4 * count), 4),
    triangles: { data: Uint32Array.from({ length: count }, (_, i) => i), shape: [count / 3, 3] },
  };
  return [COARSE, CRUDE].map((how) => {
    const { triangles: { data, shape } } = coarsened(arrays, 1, how);
    const sides = new Map();
    for (let t = 0; t < data.length; t += 3) {
      for (let i = 0; i < 3; i++) {
        const edge = [data[t + i], data[t + ((i + 1) % 3)]].sort((a, b) => a - b).join(" ");
        sides.set(edge, (sides.get(edge) ?? 0) + 1);
      }
    }
    return [shape[0], [...sides.values()].filter((many) => many === 1).length];
  });
}
"""


def test_coarse_skins_of_sharp_edges_are_not_torn(tab: Any) -> None:
    for triangles, torn in tab.page.evaluate(TORN):
        assert 12 <= triangles < 0.6 * 2976
        assert torn == 0
