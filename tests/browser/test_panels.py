"""The panels Body and World, and the keys, as a person uses them."""

from __future__ import annotations

import json
import math
import tomllib
from pathlib import Path
from typing import Any

import pytest
from hands import drag_slider

PATH_TO_THE_RIGHT = [[-3.0, 0.0]]


def test_dragged_speed_is_walked_and_undone_in_one_step(tab: Any) -> None:
    tab.open_panel("Body")
    most = tab.ask("polypod.creature.ranges.speed.most")
    drag_slider(tab, "Speed", 0.5)
    tab.until(
        lambda: tab.document["command"]["speed"] == pytest.approx(0.5 * most, rel=0.05),
        "half of the greatest speed is asked for",
    )
    tab.until(
        lambda: tab.ask("polypod.frame.focus.speed") > 0.4 * most, "it walks faster than before"
    )
    tab.keep("body")
    tab.button("Undo").click()
    tab.until(lambda: tab.document["command"]["speed"] is None, "one undo takes the drag back")


def test_typed_number_beyond_the_range_is_refused_with_a_word(tab: Any) -> None:
    tab.open_panel("Body")
    before = tab.box("Speed in m/s").input_value()
    tab.type_into("Speed in m/s", "5000")
    tab.until(lambda: "5000" in tab.words, "the refusal is said")
    assert tab.document["command"]["speed"] is None
    tab.until(lambda: tab.box("Speed in m/s").input_value() == before, "the box shows what holds")


def test_default_button_goes_back_to_the_creatures_own(tab: Any) -> None:
    tab.open_panel("Body")
    usual = float(tab.box("Step height in m").input_value())
    tab.type_into("Step height in m", str(1.5 * usual))
    tab.until(lambda: tab.document["command"]["step_height"] is not None, "it is asked for")
    tab.page.get_by_role("button", name="Step height: back to default").click()
    tab.until(lambda: tab.document["command"]["step_height"] is None, "it is the default again")
    assert float(tab.box("Step height in m").input_value()) == usual


def test_tempo_follows_the_speed_until_someone_takes_hold(tab: Any) -> None:
    tab.open_panel("Body")
    by_speed = tab.page.get_by_role("checkbox", name="Period by speed")
    assert by_speed.is_checked()
    by_speed.uncheck()
    held = tab.until(lambda: tab.document["command"]["period"], "the period is held")
    assert held == pytest.approx(1.0 / tab.ask("polypod.frame.focus.cycleRate"), rel=0.3)
    by_speed.check()
    tab.until(lambda: tab.document["command"]["period"] is None, "it follows the speed again")


def test_heading_pad_turns_the_creature_off_its_path(tab: Any) -> None:
    tab.ask(f"polypod.edit(['path'], {PATH_TO_THE_RIGHT})")
    tab.until(lambda: tab.document["path"], "it follows a path")
    tab.open_panel("Body")
    pad = tab.slider("Heading")
    place = pad.bounding_box()
    # The left of the pad is +x, a quarter turn to the left.
    tab.page.mouse.click(place["x"] + 24, place["y"] + place["height"] / 2)
    tab.until(
        lambda: tab.document["command"]["heading"] == pytest.approx(math.pi / 2, abs=0.1),
        "the heading is to the left",
    )
    tab.until(lambda: tab.document["path"] == [], "the path is gone")
    tab.until(lambda: tab.ask("polypod.frame.focus.heading") > 0.8, "it turns to its left")
    pad.focus()
    tab.page.keyboard.press("ArrowRight")
    tab.until(
        lambda: round(math.degrees(tab.document["command"]["heading"])) == 85,
        "an arrow key on the pad turns by 5 degrees",
    )


def test_push_button_throws_the_body_to_its_left(tab: Any) -> None:
    tab.ask("polypod.edit(['command', 'speed'], 0)")
    tab.until(lambda: abs(tab.ask("polypod.frame.focus.speed")) < 1e-3, "it stands")
    across = "polypod.frame.herds[0].body[4]"
    before = tab.ask(across)
    tab.open_panel("Body")
    tab.button("Push it left").click()
    tab.until(lambda: tab.ask(across) > before + 0.01, "the body is off to +x, its left")


def test_keys_play_step_and_steer_and_rest_while_typing(tab: Any) -> None:
    press = tab.page.keyboard.press
    tab.open_panel("Body")
    tab.leave()
    for _ in range(3):
        press("ArrowLeft")
    tab.until(
        lambda: round(math.degrees(tab.document["command"]["heading"])) == 30, "three times 10"
    )
    press("Control+z")
    tab.until(lambda: tab.document["command"]["heading"] == 0.0, "quick presses are one step")
    press("Control+Shift+z")
    tab.until(lambda: tab.document["command"]["heading"] > 0.5, "and redone as one")
    # A button that was clicked does not take the space bar; typing in a box does.
    tab.button("Push it left").click()
    press(" ")
    tab.until(lambda: tab.ask("polypod.clock.playing") is False, "the space bar pauses")
    number = tab.ask("polypod.frame.number")
    press(".")
    tab.until(lambda: tab.ask("polypod.frame.number") == number + 1, "a point is a single step")
    tab.box("Speed in m/s").focus()
    press("r")
    press("ArrowLeft")
    press("Escape")
    tab.leave()
    press("?")
    tab.until(tab.page.get_by_role("dialog", name="Keys").is_visible, "the list of keys")
    assert tab.ask("polypod.tape.recording") is False
    assert round(math.degrees(tab.document["command"]["heading"])) == 30
    tab.keep("keys")


def test_crate_is_added_turned_moved_and_deleted(tab: Any) -> None:
    tab.open_panel("World")
    tab.button("Add a box").click()
    tab.until(lambda: len(tab.document["obstacle"]) == 1, "a crate is there")
    crate = tab.document["obstacle"][0]
    assert crate["position"][1] == pytest.approx(crate["size"][1] / 2)
    tab.type_into("Turn in degrees", "30")
    tab.until(
        lambda: tab.document["obstacle"][0]["yaw"] == pytest.approx(math.pi / 6), "it is turned"
    )
    tab.page.get_by_role("checkbox", name="forbidden to feet").check()
    tab.until(lambda: tab.document["obstacle"][0].get("forbidden"), "feet keep off it")
    tab.page.get_by_role("combobox", name="How it moves").select_option("velocity")
    where = "polypod.frame.obstacles[6]"
    before = tab.ask(where)
    tab.until(lambda: tab.ask(where) < before - 0.05, "it moves toward -z")
    tab.keep("world")
    tab.button("Delete box-1, forbidden, moving").click()
    tab.until(lambda: tab.document["obstacle"] == [], "it is deleted")


def test_ground_is_made_when_asked_and_undone(tab: Any) -> None:
    tab.open_panel("World")
    make = tab.button("Make this ground")
    assert make.is_disabled()
    tab.page.get_by_role("combobox", name="Ground", exact=True).select_option("stairs")
    tab.type_into("rise in m", "0.05")
    assert tab.document["terrain"] is None
    make.click()
    tab.until(lambda: tab.document["terrain"], "the stairs are there")
    assert tab.document["terrain"]["rise"] == 0.05
    tab.until(make.is_disabled, "there is nothing left to make")
    tab.button("Undo").click()
    tab.until(lambda: tab.document["terrain"] is None, "the ground is flat again")


def test_crowd_walks_beside_and_stays_within_its_bounds(tab: Any) -> None:
    tab.open_panel("World")
    tab.button("Add a kind").click()
    tab.until(lambda: tab.document["crowd"], "a kind is there")
    tab.page.get_by_role("combobox", name="Kind 1", exact=True).select_option("ant")
    everyone = "polypod.frame.herds.reduce((sum, {count}) => sum + count, 0)"
    tab.until(lambda: tab.ask(everyone) == 11, "ten ants walk beside the spider")
    tab.type_into("How many of kind 1", "500")
    tab.until(lambda: "200" in tab.words, "more than 200 are refused")
    assert tab.document["crowd"] == [{"rig": "ant", "count": 10}]


def test_a_crowd_of_ones_own_rig_is_of_its_size(tab: Any) -> None:
    asked = {**tab.document["creature"], "rig": "wolf", "height": 0.4}
    tab.ask(
        f"polypod.send({{do: 'open', document: {json.dumps({**tab.document, 'creature': asked})}}})"
    )
    tab.until(lambda: tab.ask("polypod.creature.name") == "wolf", "a small wolf walks")
    tab.open_panel("World")
    tab.button("Add a kind").click()
    tab.until(lambda: tab.document["crowd"], "a kind is there")
    assert tab.document["crowd"] == [{"rig": "wolf", "height": 0.4, "count": 10}]
    # Of another size it is chosen in the Rig panel, for all of them.
    tab.open_panel("Rig")
    tab.until(tab.button("It walks").is_visible, "it is looked at")
    tab.type_into("Height in m", "0.6")
    tab.until(tab.button("Walk it").is_enabled, "it is judged")
    tab.button("Walk it").click()
    tab.until(lambda: tab.document["creature"]["height"] == 0.6, "it is larger")
    assert tab.document["crowd"][0]["height"] == 0.6


def test_scene_is_saved_and_opened_again(tab: Any, tmp_path: Path) -> None:
    tab.open_panel("World")
    tab.button("Add a cylinder").click()
    tab.until(lambda: tab.document["obstacle"], "a cylinder is there")
    _, saved = tab.download(tab.button("Save scene").click)
    scene = tomllib.loads(saved.decode())
    assert [one["shape"] for one in scene["obstacle"]] == ["cylinder"]
    file = tmp_path / "scene.toml"
    file.write_bytes(saved)
    tab.button("Delete all").click()
    tab.until(lambda: tab.document["obstacle"] == [], "it is gone")
    tab.page.get_by_label("Scene file").set_input_files(file)
    tab.until(lambda: tab.document["obstacle"], "it is back")
    file.write_text("[[obstacle]]\nshape = 'pyramid'\n")
    tab.page.get_by_label("Scene file").set_input_files(file)
    tab.until(lambda: "pyramid" in tab.words, "a scene that is none is refused with a word")


def test_feet_are_listed_alike_everywhere(tab: Any) -> None:
    tab.open_panel("Feet")
    choice = tab.page.get_by_role("combobox", name="Foot").locator("visible=true")
    feet = [name.removesuffix("Foot") for name in choice.locator("option").all_text_contents()]
    assert feet == [f"{side}Leg{i}" for i in (1, 2, 3, 4) for side in ("Left", "Right")]
    tab.open_panel("Gait")
    assert tab.page.locator(".wheels [role=group]").count() >= 8
    tab.open_panel("Rig")
    legs = tab.page.get_by_role("list", name="Legs", exact=True).get_by_role("listitem")
    tab.until(lambda: legs.count() == 8, "its legs are found")
    rows = legs.locator("span.grow").all_text_contents()
    assert all(row.endswith(f"{foot}Foot") for row, foot in zip(rows, feet, strict=True)), rows
