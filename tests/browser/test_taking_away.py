"""The panels Rig and Record, and links, as a person uses them."""

from __future__ import annotations

import io
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hands import drop_file

from polypod.rigs.gltf import GltfDocument

# Whatever takes clicks or keys must say what it is.
NAMELESS = """
[...document.querySelectorAll("button, input, select, [role=slider], [role=tab], [tabindex]")]
  .filter((one) => one.type !== "hidden")
  .filter((one) => !(one.getAttribute("aria-label") || one.getAttribute("aria-labelledby")
    || one.labels?.length || one.textContent.trim() || one.title))
  .map((one) => one.outerHTML)
"""


def test_own_rig_is_judged_sized_corrected_and_walks(
    tab: Any, shared_rig: Callable[[str], Path]
) -> None:
    fox = shared_rig("khronos_fox/Fox.glb")
    drop_file(tab, "Fox.glb", fox.read_bytes())
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
    # Another test may have left a tape.
    tab.until(lambda: tab.ask("polypod.tape.recording"), "it is recorded")
    tab.until(lambda: tab.ask("polypod.tape.frames") > 60, "a second is recorded")
    tab.page.keyboard.press("r")
    tab.until(lambda: not tab.ask("polypod.tape.recording"), "the record has ended")
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
