"""Limits of joints in the Rig panel: chosen, dragged, typed, seen, undone, taken away."""

from __future__ import annotations

import math
import tomllib
from typing import Any

import pytest

LEFT, RIGHT = "LeftLeg2Tibia", "RightLeg2Tibia"
# How a joint is turned against the one before it, degrees, in each frame that comes from now on.
WATCH = """
window.turned = [];
polypod.on("frame", (frame) => {
  const { herds } = frame;
  const at = (joint) => Array.from(herds[0].pose.slice(7 * joint, 7 * joint + 4));
  const { limits } = polypod.creature;
  const joint = limits.find(({ name }) => name === "LeftLeg2Tibia");
  const [ax, ay, az, aw] = at(joint.of), [bx, by, bz, bw] = at(joint.joint);
  const own = [
    aw * bx - bw * ax - (ay * bz - az * by), aw * by - bw * ay - (az * bx - ax * bz),
    aw * bz - bw * az - (ax * by - ay * bx), aw * bw + ax * bx + ay * by + az * bz,
  ];
  const sine = own[0] * joint.axis[0] + own[1] * joint.axis[1] + own[2] * joint.axis[2];
  window.turned.push({ time: frame.time, angle: (2 * Math.atan2(sine, own[3]) * 180) / Math.PI });
});
null; // what a browser is asked for must be no function
"""


def turns(tab: Any, joint: str) -> list[dict[str, Any]]:
    """Return how far a joint turns, as the page was told last."""
    of = f"polypod.creature.limits.find(({{ name }}) => name === {joint!r}).turns"
    return tab.ask(f"JSON.parse(JSON.stringify({of}))")


def degrees(tab: Any, joint: str) -> list[float]:
    """Return the least and the most bend of a hinge."""
    [turn] = turns(tab, joint)
    return [math.degrees(turn["least"]), math.degrees(turn["most"])]


def open_limits(tab: Any, joint: str) -> None:
    """Open the Rig panel and choose a joint in the tree."""
    tab.open_panel("Rig")
    verdict = tab.page.locator(".verdict")
    tab.until(lambda: "It can walk" in verdict.text_content(), "the rig is judged")
    tab.page.get_by_role("treeitem", name=joint).click()
    chosen = tab.page.get_by_role("combobox", name="Joint", exact=True)
    tab.until(lambda: chosen.input_value() == joint, "it is chosen in the list too")


def turn_handle(tab: Any, name: str, by: float) -> None:
    """Drag an end of a dial's arc round its middle by so many degrees."""
    handle = tab.slider(name)
    handle.scroll_into_view_if_needed()
    group = tab.page.get_by_role("group", name=name.rsplit(" ", 1)[0], exact=True).bounding_box()
    middle = group["x"] + group["width"] / 2, group["y"] + group["height"] / 2
    knob = handle.bounding_box()
    x = knob["x"] + knob["width"] / 2 - middle[0]
    y = knob["y"] + knob["height"] / 2 - middle[1]
    mouse = tab.page.mouse
    mouse.move(middle[0] + x, middle[1] + y)
    mouse.down()
    for i in range(1, 9):
        turn = math.radians(by * i / 8.0)
        cosine, sine = math.cos(turn), math.sin(turn)
        mouse.move(middle[0] + x * cosine - y * sine, middle[1] + x * sine + y * cosine)
    mouse.up()


def test_a_dragged_limit_is_obeyed_mirrored_saved_and_undone(tab: Any) -> None:
    open_limits(tab, LEFT)
    least, most = degrees(tab, LEFT)
    fans = "polypod.creature.fans.filter((fan) => fan.key === 'bend').length"
    assert tab.ask(fans) > 8
    tab.keep("limits-1-chosen")
    wanted = -20.0
    turn_handle(tab, f"{LEFT} bend most", wanted - most)
    tab.until(
        lambda: degrees(tab, LEFT)[1] == pytest.approx(wanted, abs=3.0), "it is limited as dragged"
    )
    tab.page.wait_for_timeout(300)
    low, high = degrees(tab, LEFT)
    assert degrees(tab, RIGHT) == [low, high], "the other side goes along"
    assert low == pytest.approx(least)
    fan = "polypod.creature.fans.find((fan) => fan.joint === J && fan.key === 'bend').most"
    joint = f"polypod.creature.limits.find(({{ name }}) => name === {LEFT!r}).joint"
    assert math.degrees(tab.ask(fan.replace("J", joint))) == pytest.approx(high)
    # The leg obeys, in every frame that comes.
    tab.ask(WATCH)
    long = "turned.length ? turned.at(-1).time - turned[0].time : 0"
    tab.until(lambda: tab.ask(long) > 3.0, "it walks on for 3 s", 120.0)
    angles = tab.ask("turned.map(({ angle }) => angle)")
    assert low - 0.01 <= min(angles) < max(angles) <= high + 0.01
    tab.keep("limits-2-dragged")
    name, saved = tab.download(tab.button("Save as creature file").click)
    assert name == "spider.toml"
    kept = tomllib.loads(saved.decode())["limit"]
    assert set(kept) == {LEFT, RIGHT}
    assert [math.degrees(angle) for angle in kept[LEFT]["bend"]] == pytest.approx([low, high])
    tab.button("Undo").click()
    tab.until(
        lambda: tab.document["creature"]["limit"] is None, "one undo takes the whole drag back"
    )
    tab.until(lambda: degrees(tab, LEFT) == pytest.approx([least, most]), "and it turns as before")


def test_a_typed_limit_goes_back_to_its_default(tab: Any) -> None:
    open_limits(tab, "LeftLeg1Coxa")
    tab.button("Mirror limits left and right").click()
    tab.type_into("Sideways either way in degrees", "40")
    tab.until(lambda: tab.document["creature"]["limit"], "it is asked for")
    limit = tab.document["creature"]["limit"]
    assert limit == {"LeftLeg1Coxa": {"sideways": pytest.approx(math.radians(40.0))}}
    assert turns(tab, "RightLeg1Coxa")[1]["most"] == pytest.approx(math.radians(60.0))
    tab.slider("LeftLeg1Coxa flexion most").focus()
    tab.page.keyboard.press("Shift+ArrowLeft")
    tab.until(
        lambda: tab.document["creature"]["limit"]["LeftLeg1Coxa"].get("flexion"), "a key turns it"
    )
    flexion = tab.document["creature"]["limit"]["LeftLeg1Coxa"]["flexion"]
    assert flexion == pytest.approx(math.radians(85.0))
    tab.keep("limits-3-hip")
    tab.page.get_by_role("button", name="Sideways either way: back to default").click()
    tab.slider("LeftLeg1Coxa flexion most").focus()
    tab.page.keyboard.press("Delete")
    tab.until(lambda: tab.document["creature"]["limit"] is None, "all is as found again")


def test_a_limit_that_it_cannot_stand_with_is_refused_with_a_word(tab: Any) -> None:
    open_limits(tab, LEFT)
    before = degrees(tab, LEFT)
    tab.type_into("Bends from in degrees", "80")
    tab.until(lambda: f"{LEFT} cannot be limited so" in tab.words, "it is said which and why")
    assert "LeftLeg2Foot" in tab.words
    assert tab.document["creature"]["limit"] is None
    assert degrees(tab, LEFT) == before
    time = tab.ask("polypod.frame.time")
    tab.until(lambda: tab.ask("polypod.frame.time") > time + 0.3, "the walk goes on")
