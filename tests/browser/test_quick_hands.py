"""Hands that are quicker than the studio's answers: nothing that was asked for is lost."""

from __future__ import annotations

import re
from typing import Any

import pytest
from hands import name_of

# All of it happens in one task of the page, so that no answer comes between.
TYPED = """
const typed = (name, text) => {
  const box = document.querySelector(`input[aria-label="${name}" i]`);
  box.focus();
  box.value = text;
  box.dispatchEvent(new Event("input", { bubbles: true }));
  box.dispatchEvent(new Event("change", { bubbles: true }));
};
const chosen = (name, value) => {
  const list = document.querySelector(`select[aria-label="${name}"]`);
  list.value = value;
  list.dispatchEvent(new Event("change", { bubbles: true }));
};
const dragged = (name, values) => {
  const range = document.querySelector(`[aria-label="${name}"] input[type=range]`);
  for (const value of values) {
    range.value = value;
    range.dispatchEvent(new Event("input", { bubbles: true }));
  }
  range.dispatchEvent(new Event("change", { bubbles: true }));
};
const pressed = (name) => document.querySelector(`[aria-label="${name}"]`).click();
const struck = (element, key) =>
  element.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true, cancelable: true }));
const worded = (words) =>
  [...document.querySelectorAll("button")].find((button) => button.textContent === words).click();
"""


def at_once(tab: Any, deeds: str) -> None:
    """Do several things before the studio can answer the first."""
    tab.ask(f"() => {{ {TYPED} {deeds} }}")
    tab.ask("polypod.orders.settled()")


def test_a_gait_chosen_right_after_a_number_keeps_the_number(tab: Any) -> None:
    tab.open_panel("Gait")
    at_once(tab, "typed('Blend in in cycles', '3'); chosen('Gait', 'trot');")
    assert tab.document["command"]["blend_cycles"] == 3.0
    assert tab.document["gait"]["name"] == "trot"
    assert tab.box("Blend in in cycles").input_value() == "3.00"
    # A drag's newest value waits for the one before it; what is chosen then comes after it.
    at_once(tab, "dragged('Blend in', [1, 2, 4]); chosen('Gait', 'tripod');")
    assert tab.document["command"]["blend_cycles"] == pytest.approx(4.0, abs=0.05)
    assert tab.document["gait"]["name"] == "tripod"
    tab.button("Undo").click()
    tab.until(lambda: tab.document["gait"]["name"] == "trot", "the gait is undone first")
    tab.button("Undo").click()
    tab.until(lambda: tab.document["command"]["blend_cycles"] == 3.0, "then the drag, as one step")


def test_a_wheel_turned_right_after_a_gait_was_chosen_turns_that_gait(tab: Any) -> None:
    tab.open_panel("Gait")
    name = name_of(tab, 0)
    at_once(
        tab,
        f"const handle = document.querySelector('[aria-label=\"{name} whole swing\"]');"
        "for (let n = 0; n < 3; n++) struck(handle, 'ArrowRight'); chosen('Gait', 'wave');",
    )
    assert tab.document["gait"]["name"] == "wave"


def test_numbers_of_a_crate_and_points_of_a_path_add_up(tab: Any) -> None:
    tab.open_panel("World")
    tab.button("Add a box").click()
    tab.until(lambda: tab.box("Size x in m").is_visible(), "a crate is there and chosen")
    at_once(tab, "typed('Size x in m', '0.2'); typed('Size z in m', '0.3'); pressed('Add a box');")
    first, second = tab.document["obstacle"]
    assert (first["size"][0], first["size"][2]) == (0.2, 0.3)
    assert first["name"] != second["name"]
    at_once(tab, "worded('Add a point'); worded('Add a point'); worded('Add a point');")
    assert len(tab.document["path"]) == 3
    at_once(tab, "pressed('Delete point 1'); pressed('Delete point 1');")
    assert len(tab.document["path"]) == 1
    second = tab.document["obstacle"][1]["name"]
    at_once(tab, "pressed('Add a sphere'); pressed('Delete box-1'); pressed('Delete sphere-1');")
    assert [one["name"] for one in tab.document["obstacle"]] == [second]
    at_once(tab, "worded('Add a kind'); worded('Add a kind');")
    tab.until(lambda: [kind["count"] for kind in tab.document["crowd"]] == [10, 10], "both kinds")


def test_what_is_typed_while_ground_is_made_stays(tab: Any) -> None:
    tab.open_panel("World")
    at_once(
        tab,
        "chosen('Ground', 'hills'); worded('Make this ground'); typed('seed', '7');",
    )
    assert tab.document["terrain"]["generator"] == "hills"
    seed = tab.page.get_by_role("spinbutton", name=re.compile("^seed$", re.IGNORECASE))
    assert seed.input_value() == "7"
    tab.button("Make this ground").click()
    tab.until(lambda: tab.document["terrain"]["seed"] == 7, "what was typed is made now")


def test_pause_pressed_twice_plays(tab: Any) -> None:
    tab.leave()
    at_once(tab, "struck(document.body, ' '); struck(document.body, ' ');")
    assert tab.ask("polypod.clock.playing")
    at_once(tab, "for (let n = 0; n < 3; n++) struck(document.body, ' ');")
    assert not tab.ask("polypod.clock.playing")


def test_a_refused_number_gives_way_to_what_holds(tab: Any) -> None:
    tab.open_panel("Gait")
    at_once(tab, "typed('Blend in in cycles', '3'); typed('Blend in in cycles', '500');")
    assert tab.document["command"]["blend_cycles"] == 3.0
    tab.until(
        lambda: tab.box("Blend in in cycles").input_value() == "3.00", "the box shows what holds"
    )
    assert "blend_cycles" in tab.words
