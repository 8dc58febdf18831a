"""Gait wheels, feet spacing, footfalls and plots, as a person uses them."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from typing import Any

import pytest
from hands import drag_by, in_use, name_of, turn_handle

LEFT, RIGHT = 4, 5  # a pair of the spider's feet
APART = 0.004  # of the cycle: nearer is the same
# The pixels of a canvas that have one of the feet's colours.
COLOURED = """
(name) => {
  const canvas = document.querySelector(name);
  const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
  const wanted = polypod.creature.feet.map(({ colour }) =>
    [1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16)));
  return wanted.map(([r, g, b]) => {
    let count = 0;
    for (let i = 0; i < data.length; i += 4) {
      const off = Math.abs(data[i] - r) + Math.abs(data[i + 1] - g) + Math.abs(data[i + 2] - b);
      if (off < 12) count += 1;
    }
    return count;
  });
}
"""


def settle(tab: Any) -> None:
    """Open the Gait panel, and wait until the walk has got to its speed and its disks stay."""
    tab.open_panel("Gait")

    def stays() -> bool:
        before = in_use(tab, LEFT)
        tab.page.wait_for_timeout(400)
        now = in_use(tab, LEFT)
        turns = tab.ask("polypod.frame.focus.speed > 0.05")
        return turns and max(abs(now[i] - before[i]) for i in (0, 1)) < 1e-3

    tab.until(stays, "it walks steadily")


def asked(tab: Any, foot: int) -> tuple[float, float]:
    gait = tab.document["gait"]
    return gait["start"][foot], gait["extent"][foot]


def apart(one: float, other: float) -> float:
    """Return how far apart two phases are on the circle."""
    return abs((one - other + 0.5) % 1.0 - 0.5)


def test_a_sectors_end_is_dragged_and_the_foot_walks_by_it(tab: Any) -> None:
    settle(tab)
    before = [in_use(tab, foot) for foot in (LEFT, RIGHT)]
    turn_handle(tab, LEFT, "swing finish", -0.12)
    tab.until(lambda: tab.document["gait"], "the gait is drawn by hand")
    assert tab.document["gait"]["name"] == "edited"
    for foot, (start, extent) in zip((LEFT, RIGHT), before, strict=True):
        # Mirrored: the other side's foot steps as much shorter, and when it did.
        tab.until(
            lambda foot=foot, extent=extent: abs(asked(tab, foot)[1] - extent + 0.12) < 0.02,
            "the swing is shorter by what was dragged",
        )
        assert apart(asked(tab, foot)[0], start) < APART
    wanted = asked(tab, LEFT)[1]
    tab.until(lambda: abs(in_use(tab, LEFT)[1] - wanted) < 0.01, "the foot walks by it")
    tab.keep("gait-dragged")
    tab.button("Undo").click()
    tab.until(lambda: tab.document["gait"] is None, "one undo takes the drag back")
    tab.button("Redo").click()
    tab.until(lambda: tab.document["gait"], "redo draws it again")


def test_handles_snap_to_the_cycles_parts_and_the_others_events(tab: Any) -> None:
    settle(tab)
    turn_handle(tab, LEFT, "swing start", 0.07, free=False)
    tab.until(lambda: tab.document["gait"], "the gait is drawn by hand")
    tab.page.wait_for_timeout(500)
    gait = tab.document["gait"]
    places = [n / 24.0 for n in range(24)]
    for foot in range(len(gait["start"])):
        if foot not in (LEFT, RIGHT):
            places += [gait["start"][foot], gait["start"][foot] + gait["extent"][foot]]
    assert min(apart(gait["start"][LEFT], place) for place in places) < 1e-5


def test_keys_move_handles_by_a_hundredth_and_by_five(tab: Any) -> None:
    settle(tab)
    tab.button("Mirror left and right").click()
    start, extent = in_use(tab, LEFT)
    partner = in_use(tab, RIGHT)[0]
    handle = tab.slider(f"{name_of(tab, LEFT)} whole swing")
    handle.focus()
    for key in ("ArrowRight", "ArrowRight", "Shift+ArrowUp", "ArrowLeft"):
        handle.press(key)
    tab.until(
        lambda: tab.document["gait"] and apart(asked(tab, LEFT)[0], start + 0.06) < APART,
        "the swing begins 6 % later",
    )
    assert asked(tab, LEFT)[1] == pytest.approx(extent, abs=1e-4)
    assert apart(asked(tab, RIGHT)[0], partner) < APART
    told = float(handle.get_attribute("aria-valuenow"))
    assert apart(told / 100.0, start + 0.06) < APART
    assert handle.evaluate("(it) => it === document.activeElement")
    tab.button("Undo").click()
    tab.until(lambda: tab.document["gait"] is None, "strokes in a row are one step of undo")


def test_a_duty_is_typed_and_goes_back(tab: Any) -> None:
    settle(tab)
    tab.page.get_by_role("combobox", name="Foot").select_option(str(LEFT))
    start, extent = in_use(tab, LEFT)
    tab.type_into("Stands for in %", "80")
    tab.until(
        lambda: tab.document["gait"] and asked(tab, LEFT)[1] == pytest.approx(0.2, abs=1e-6),
        "the foot stands for 80 %",
    )
    assert apart(sum(asked(tab, LEFT)), start + extent) < APART, "it lands when it did"
    tab.page.get_by_role("button", name="Stands for: back to default").click()
    tab.until(lambda: abs(asked(tab, LEFT)[1] - extent) < APART, "it stands as long as before")


def test_a_gait_is_blended_to_and_the_disks_move(tab: Any) -> None:
    settle(tab)
    tab.type_into("Blend in in cycles", "3")
    tab.until(lambda: tab.document["command"]["blend_cycles"] == 3.0, "it blends in 3 cycles")
    choice = tab.page.get_by_role("combobox", name="Gait")
    first = in_use(tab, LEFT)
    choice.select_option("trot")
    tab.until(lambda: (tab.document["gait"] or {}).get("name") == "trot", "a trot is asked for")
    wheel = tab.page.get_by_role("group", name=f"{name_of(tab, LEFT)} wheel", exact=True)
    sector = wheel.locator(".wheel-swing")
    shapes = set()
    for _ in range(20):
        shapes.add(sector.get_attribute("d"))
        tab.page.wait_for_timeout(50)
    tab.keep("gait-blending")
    assert len(shapes) > 3, "the sector moves while it blends"
    tab.page.wait_for_timeout(4000)
    assert in_use(tab, LEFT) != first
    choice.select_option("follows speed")
    tab.until(lambda: tab.document["gait"] is None, "it follows speed again")


def test_a_gait_that_none_can_walk_is_told_while_it_is_drawn(tab: Any) -> None:
    settle(tab)
    badge = tab.page.get_by_role("status", name="Plausibility")
    tab.until(lambda: "plausible" in badge.text_content(), "the gait is judged")
    assert "implausible" not in badge.text_content()
    tab.ask(
        "polypod.edit(['gait'], {name: 'edited', start: polypod.creature.feet.map(() => 0.1),"
        " extent: polypod.creature.feet.map(() => 0.9)})"
    )
    tab.until(lambda: "implausible" in badge.text_content(), "it is told to be implausible")
    peaks = tab.page.get_by_role("list", name="Peak force of each foot").get_by_role("listitem")
    assert peaks.count() == tab.ask("polypod.creature.feet.length")
    sentence = tab.page.locator(".verdict-sentence")
    tab.until(lambda: "plausible with a" in sentence.text_content(), "what would mend it is found")
    assert "looking for" not in sentence.text_content()
    tab.keep("gait-implausible")
    tab.button("Undo").click()
    tab.until(lambda: "implausible" not in badge.text_content(), "what was before is plausible")


def test_footfalls_are_drawn_in_every_foots_colour(tab: Any) -> None:
    tab.open_panel("Gait")
    tab.page.wait_for_timeout(2500)
    for canvas in (".footfalls", ".strip-plots canvas"):
        assert min(tab.page.evaluate(COLOURED, canvas)) > 20, canvas


def test_a_foot_is_dragged_and_its_partner_goes_along(tab: Any) -> None:
    tab.open_panel("Feet")
    place = tab.page.get_by_role("button", name=f"{name_of(tab, LEFT)} place:")
    before = place.bounding_box()
    drag_by(tab, place, -18.0, -12.0)
    tab.until(lambda: tab.document["spacing"], "feet are placed")
    tab.until(
        lambda: abs(place.bounding_box()["x"] - before["x"] + 18.0) < 1.0, "it is where it was put"
    )
    left, right = (tab.document["spacing"][foot] for foot in (LEFT, RIGHT))
    assert left[0] > 0.0
    assert left[1] == pytest.approx(left[0] * 12.0 / 18.0, rel=0.05)
    assert right == [pytest.approx(-left[0]), pytest.approx(left[1])]
    wanted = tab.ask(f"polypod.creature.feet[{LEFT}].rest[0]") + left[0]
    tab.until(
        lambda: tab.ask(PLACE_LEFT) == pytest.approx(wanted, abs=0.25 * left[0]),
        "the foot walks farther out",
    )
    tab.keep("feet-dragged")
    tab.button("Reset all").click()
    tab.until(
        lambda: not any(any(pair) for pair in tab.document["spacing"]), "all feet are at rest again"
    )


# How far to the left of the body the foot that was dragged is, m.
PLACE_LEFT = f"""
(() => {{
  const {{ focus, herds }} = polypod.frame;
  const [x, , z] = focus.feet[{LEFT}].sole;
  const body = herds[focus.kind].body;
  return (x - body[4]) * Math.cos(focus.heading) - (z - body[6]) * Math.sin(focus.heading);
}})()
"""


def test_arrows_move_one_foot_by_a_hundredth_of_the_leg(tab: Any) -> None:
    tab.open_panel("Feet")
    tab.button("Symmetric").click()
    place = tab.page.get_by_role("button", name=f"{name_of(tab, LEFT)} place:")
    place.focus()
    for key in ("ArrowUp", "ArrowUp", "ArrowRight"):
        place.press(key)
    step = 0.01 * tab.ask("polypod.creature.leg_length")
    tab.until(
        lambda: (
            tab.document["spacing"]
            and tab.document["spacing"][LEFT] == pytest.approx([-step, 2.0 * step], abs=2e-5)
        ),
        "two steps forward and one to the right",
    )
    assert tab.document["spacing"][RIGHT] == [0.0, 0.0]
    place.press("Delete")
    tab.until(lambda: tab.document["spacing"][LEFT] == [0.0, 0.0], "Delete resets it")


def test_what_is_recorded_is_scrubbed_by_keys_and_by_the_mouse(tab: Any) -> None:
    tab.ask("polypod.send({do: 'record', on: true})")
    tab.until(lambda: tab.ask("polypod.tape.seconds") > 2.0, "two seconds are recorded")
    tab.ask("polypod.send({do: 'record', on: false})")
    slider = tab.slider("Recorded time")
    slider.focus()
    slider.press("Home")
    for _ in range(5):
        slider.press("ArrowRight")
    tab.until(lambda: tab.ask("polypod.frame.tapeFrame") == 5, "frame 5 of the tape is shown")
    tab.until(lambda: slider.get_attribute("aria-valuenow") == "5", "the slider says so")
    plots = tab.page.locator(".strip-plots").bounding_box()
    gutter = 128
    x = plots["x"] + gutter + 0.5 * (plots["width"] - gutter)
    tab.page.mouse.click(x, plots["y"] + 20)
    frames = tab.ask("polypod.tape.frames")
    tab.until(
        lambda: tab.ask("polypod.frame.tapeFrame") == pytest.approx(frames / 2, abs=2), "its middle"
    )
    tab.keep("strip-scrubbed")
    assert min(tab.page.evaluate(COLOURED, ".strip-plots canvas")) > 20
    tab.button("Live").click()
    tab.until(lambda: tab.ask("polypod.frame.tapeFrame") is None, "the walk goes on")


def test_lanes_are_chosen_and_stay_chosen(new_tab: Callable[..., Any]) -> None:
    tab = new_tab()
    speed = tab.page.get_by_role("group", name="Plots to show").get_by_role("button", name="Speed")
    assert speed.get_attribute("aria-pressed") == "false"
    speed.click()
    tab.page.reload()
    assert speed.get_attribute("aria-pressed") == "true"


# The wheels' circle fed with sixty frames a second by a clock of its own: after a second everything
# is turned by .4 of a cycle, and foot 1 takes another disk.
TURNED = """
async () => {
  const { Circle } = await import("/page/circle.js");
  const real = performance.now;
  let now = 1000;
  performance.now = () => now;
  let hear;
  const circle = new Circle({ on: (kind, listener) => { hear = listener; } });
  const rate = 1.5;
  const wrap = (phase) => phase - Math.floor(phase);
  const seen = [];
  for (let n = 0; n < 360; n++) {
    now += 1000 / 60;
    const turned = n < 60 ? 0 : 0.4;
    const feet = [
      { start: wrap(0.1 + turned), extent: 0.3 },
      { start: wrap((n < 60 ? 0.6 : 0.9) + turned), extent: n < 60 ? 0.3 : 0.5 },
    ];
    const needle = wrap((rate * n) / 60 + turned);
    const focus = { kind: 0, creature: 0, needle, cycleRate: rate, feet };
    hear({ time: n / 60, tapeFrame: null, focus });
    const shown = feet.map((disk, k) => circle.shown(k, disk));
    const phase = needle - feet[0].start;
    const [first, second] = shown;
    seen.push([wrap(needle + circle.turn), first.start, second.start, second.extent, phase]);
  }
  performance.now = real;
  return seen;
}
"""


def test_wheels_stay_where_they_are_when_the_circle_is_turned(tab: Any) -> None:
    seen = tab.page.evaluate(TURNED)
    for (needle, first, second, extent, _), after in itertools.pairwise(seen):
        assert apart(after[0], needle + 1.5 / 60.0) < 0.02, "the needle goes on at its pace"
        assert apart(after[1], first) < 0.02
        assert apart(after[2], second) < 0.06, "a disk of its own goes sooner, but jumps no more"
        assert abs(after[3] - extent) < 0.03
    for needle, first, _, _, phase in seen:
        assert apart(needle - first, phase) < 1e-9, "needle and disk are as they are to each other"
    assert apart(seen[59][1], 0.1) < 1e-9
    assert apart(seen[60][1], 0.1) < 0.02
    last = seen[-1]
    assert apart(last[1], 0.5) < 0.01
    assert apart(last[2], 0.3) < 0.01
    assert last[3] == pytest.approx(0.5, abs=1e-3)


def test_what_comes_into_view_while_time_stands_is_up_to_date(tab: Any) -> None:
    settle(tab)
    tab.open_panel("World")
    tab.ask("polypod.send({do: 'clock', playing: false})")
    tab.until(lambda: not tab.ask("polypod.clock.playing"), "time stands")
    tab.page.reload()
    ready = "Boolean(window.polypod?.document && polypod.creature && polypod.frame)"
    tab.until(lambda: tab.ask(ready), "the page is there again")
    tab.page.wait_for_timeout(500)
    tab.open_panel("Gait")
    tab.until(lambda: tab.box("Lifts at in %").input_value() != "", "numbers of a foot are shown")
    tab.until(lambda: min(tab.page.evaluate(COLOURED, "canvas.footfalls")) > 0, "footfalls are")
    sectors = "[...document.querySelectorAll('.wheel-swing')].map((one) => one.getAttribute('d'))"
    tab.until(lambda: all(len(d or "") > 20 for d in tab.ask(sectors)), "disks are drawn")
    assert len(tab.ask(sectors)) == 8
