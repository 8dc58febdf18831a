"""The panels Body, World, Rig and Record, the keys, and links, as a person uses them."""

from __future__ import annotations

import base64
import io
import math
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from polypod.rigs.gltf import GltfDocument

PATH_TO_THE_RIGHT = [[-3.0, 0.0]]
# Whatever takes clicks or keys must say what it is.
NAMELESS = """
[...document.querySelectorAll("button, input, select, [role=slider], [role=tab], [tabindex]")]
  .filter((one) => one.type !== "hidden")
  .filter((one) => !(one.getAttribute("aria-label") || one.getAttribute("aria-labelledby")
    || one.labels?.length || one.textContent.trim() || one.title))
  .map((one) => one.outerHTML)
"""
# A file dropped from the desktop, anywhere on the page.
DROP = """
{
  const bytes = Uint8Array.from(atob("%s"), (letter) => letter.charCodeAt(0));
  const dataTransfer = new DataTransfer();
  dataTransfer.items.add(new File([bytes], "Fox.glb"));
  for (const name of ["dragover", "drop"]) {
    const event = new DragEvent(name, { dataTransfer, bubbles: true, cancelable: true });
    document.querySelector("#scene").dispatchEvent(event);
  }
}
"""


def drag_slider(tab: Any, name: str, share: float) -> None:
    """Drag a slider's knob to a share of its length, in ten steps."""
    slider = tab.slider(name)
    slider.scroll_into_view_if_needed()
    place = slider.bounding_box()
    now = slider.evaluate("(it) => (it.value - it.min) / (it.max - it.min)")
    knob = 16  # px, which the range leaves out at its ends
    y = place["y"] + place["height"] / 2

    def x(part: float) -> float:
        return place["x"] + knob / 2 + part * (place["width"] - knob)

    tab.page.mouse.move(x(now), y)
    tab.page.mouse.down()
    for i in range(1, 11):
        tab.page.mouse.move(x(now + (share - now) * i / 10), y)
    tab.page.mouse.up()


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


def test_own_rig_is_judged_sized_corrected_and_walks(
    tab: Any, shared_rig: Callable[[str], Path]
) -> None:
    fox = shared_rig("khronos_fox/Fox.glb")
    tab.ask(DROP % base64.b64encode(fox.read_bytes()).decode())
    verdict = tab.page.locator(".verdict")
    tab.until(lambda: "4 legs, 79.0 m" in verdict.text_content(), "it is judged")
    tab.button("In centimetres? Make it 79.0 cm tall").click()
    tab.until(lambda: "79.0 cm" in verdict.text_content(), "it is 79 cm tall")
    remove = tab.page.get_by_role("button", name="Remove leg")
    remove.first.click()
    tab.until(lambda: "3 legs" in verdict.text_content(), "a leg is taken off")
    # With the keys: the hip, then the foot.
    tab.button("Add a leg").click()
    tree = tab.page.get_by_role("tree", name="Joints")
    tree.get_by_role("treeitem", name="b_LeftLeg01_015").press("Enter")
    tree.get_by_role("treeitem", name="b_LeftFoot02_018").press("Enter")
    tab.until(lambda: "4 legs" in verdict.text_content(), "and put back")
    tab.keep("rig")
    tab.button("Walk it").click()
    tab.until(lambda: tab.ask("polypod.creature.feet.length") == 4, "the fox walks")
    assert tab.ask("polypod.creature.body.height") < 1.0
    tab.until(tab.button("Save as creature file").is_enabled, "what walks can be saved")
    _, saved = tab.download(tab.button("Save as creature file").click)
    creature = tomllib.loads(saved.decode())
    assert creature["rig"] == "Fox.glb"
    assert creature["height"] == pytest.approx(0.79, abs=0.01)
    assert len(creature["leg"]) == 4


def test_rig_that_cannot_walk_says_why(tab: Any, tmp_path: Path) -> None:
    tab.open_panel("Rig")
    verdict = tab.page.locator(".verdict")
    tab.until(lambda: "8 legs" in verdict.text_content(), "the spider is judged")
    tab.button("Add a leg").click()
    tree = tab.page.get_by_role("tree", name="Joints")
    # A leg inside another.
    tree.get_by_role("treeitem", name="LeftLeg1Femur").click()
    tree.get_by_role("treeitem", name="LeftLeg1Tarsus").click()
    tab.until(lambda: "bad" in verdict.get_attribute("class"), "it is told off")
    assert "LeftLeg1" in verdict.text_content()
    assert tab.button("Walk it").is_disabled()
    tab.button("Legs as found in the file").click()
    tab.until(lambda: "8 legs" in verdict.text_content(), "as found it walks")
    text = tmp_path / "notes.txt"
    text.write_text("no rig")
    tab.page.get_by_label("Rig file").set_input_files(text)
    tab.until(lambda: "notes.txt is no GLB" in tab.words, "another file is refused")


def test_record_is_taken_away_as_glb_npz_picture_and_video(tab: Any) -> None:
    tab.open_panel("Record")
    glb = tab.button("GLB, the rig with this motion")
    tab.leave()
    tab.page.keyboard.press("r")
    tab.until(lambda: tab.ask("polypod.tape.frames") > 60, "a second is recorded")
    tab.page.keyboard.press("r")
    tab.until(glb.is_enabled, "it can be exported")
    frames = tab.ask("polypod.tape.frames")
    name, data = tab.download(glb.click)
    assert name.endswith(".glb")
    assert len(GltfDocument.from_bytes(data, name).root.parts("animations")) == 1
    _, data = tab.download(tab.button("NPZ, the record as numbers").click)
    with np.load(io.BytesIO(data), allow_pickle=False) as record:
        assert len(record["body_position"]) == frames
    _, data = tab.download(tab.button("PNG, a picture of it").click)
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    tab.button("Video of it").click()
    tab.page.wait_for_timeout(1500)
    name, data = tab.download(tab.button("■ Stop the video").click)
    assert name == "walk.webm"
    assert data[:4] == b"\x1a\x45\xdf\xa3"
    tab.keep("record")


def test_link_reproduces_the_state_and_a_broken_one_is_told(
    tab: Any, new_tab: Callable[..., Any], studio_address: str
) -> None:
    tab.ask("polypod.edit(['command', 'heading'], 0.5)")
    tab.ask("polypod.edit(['path'], [[1, 2], [3, 4.5]])")
    tab.until(lambda: tab.document["path"], "something is asked for")
    tab.open_panel("Record")
    tab.button("Copy a link to all this").click()
    link = tab.until(lambda: tab.ask("navigator.clipboard.readText()"), "the link is copied")
    wanted = tab.document
    tab.ask("polypod.edit(['path'], [])")
    tab.until(lambda: tab.ask("location.hash") == "", "the address no longer claims to hold it")
    tab.page.close()
    opened = new_tab(link)
    opened.until(lambda: opened.document == wanted, "the link's state is there")
    opened.page.goto(f"{studio_address}#nonsense")
    opened.until(lambda: "no link of the studio" in opened.words, "a broken link is told")
    assert opened.document == wanted


def test_everything_that_can_be_reached_says_what_it_is(tab: Any) -> None:
    tab.open_panel("World")
    tab.button("Add a sphere").click()
    tab.page.get_by_role("combobox", name="How it moves").select_option("path")
    tab.button("Add a point").click()
    tab.button("Add a kind").click()
    tab.until(lambda: tab.document["crowd"], "all kinds of rows are there")
    tab.open_panel("Rig")
    tab.until(lambda: tab.page.get_by_role("treeitem").count() > 0, "the joints are listed")
    assert tab.ask(NAMELESS) == []
