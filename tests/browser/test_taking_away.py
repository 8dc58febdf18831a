"""The panels Rig and Record, and links, as a person uses them."""

from __future__ import annotations

import base64
import hashlib
import io
import json
import struct
import time
import tomllib
from collections.abc import Callable, Iterator
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
    tab.button("Remove leg b_LeftLeg01_015 → b_LeftFoot02_018").click()
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
    tab.keep("record")


# What a player finds in a video: how long it is, and where it is after going to a place of it.
PLAYED = """
async (text) => {
  const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  const video = document.createElement("video");
  video.muted = true;
  const heard = (kind) => new Promise((resolve, reject) => {
    video.addEventListener(kind, resolve, { once: true });
    video.addEventListener("error", () => reject(new Error(video.error.message)), { once: true });
  });
  const loaded = heard("loadedmetadata");
  video.src = URL.createObjectURL(new Blob([bytes], { type: "video/webm" }));
  await loaded;
  const places = [];
  for (const share of [0.75, 0.25, 0.5]) {
    const sought = heard("seeked");
    video.currentTime = share * video.duration;
    await sought;
    places.push(video.currentTime / video.duration);
  }
  return { duration: video.duration, places, width: video.videoWidth };
}
"""
CLUSTER, CUES, CUE_POSITIONS, CUE_CLUSTER = "1f43b675", "1c53bb6b", "b7", "f1"


def ebml(data: bytes, begin: int, end: int) -> Iterator[tuple[str, int, int]]:
    """Yield id, begin and end of elements; one without a size goes on to the end."""
    at = begin
    while at < end:
        named = 9 - data[at].bit_length()
        name = data[at : at + named].hex()
        at += named
        length = 9 - data[at].bit_length()
        size = int.from_bytes(data[at : at + length]) - (1 << 7 * length)
        at += length
        stop = end if size == (1 << 7 * length) - 1 else at + size
        yield name, at, stop
        at = stop


def cued(data: bytes) -> list[int]:
    """Return where a video's cues lead to in the file, and judge its segment."""
    segment = next(place for place in ebml(data, 0, len(data)) if place[0] == "18538067")
    found = []
    for name, begin, end in ebml(data, *segment[1:]):
        if name == CLUSTER:
            break
        if name == CUES:
            for _, *point in ebml(data, begin, end):
                positions = [part for part in ebml(data, *point) if part[0] == CUE_POSITIONS]
                for _, *position in positions:
                    for part, at, stop in ebml(data, *position):
                        if part == CUE_CLUSTER:
                            found.append(segment[1] + int.from_bytes(data[at:stop]))
    return found


def test_a_video_of_the_view_can_be_scrubbed(tab: Any) -> None:
    tab.open_panel("Record")
    began = time.monotonic()
    tab.button("Video of it").click()
    tab.page.wait_for_timeout(3500)
    name, data = tab.download(tab.button("■ Stop the video").click)
    took = time.monotonic() - began
    assert name == "walk.webm"
    played = tab.page.evaluate(PLAYED, base64.b64encode(data).decode())
    assert 2.0 < played["duration"] < took
    assert played["places"] == pytest.approx([0.75, 0.25, 0.5], abs=0.01)
    assert played["width"] > 100
    places = cued(data)
    assert places, "there are cues"
    assert all(data[place : place + 4].hex() == CLUSTER for place in places)


def test_what_is_no_video_is_left_as_it_is(tab: Any) -> None:
    same = tab.ask(
        "async () => {"
        " const { seekable } = await import('/page/webm.js');"
        " const odd = ['', 'no video', '\\x1aE', String.fromCharCode(26, 69, 31, 35)];"
        " const blobs = odd.map((text) => new Blob([text]));"
        " return (await Promise.all(blobs.map(async (one) => (await seekable(one)) === one)))"
        "}"
    )
    assert same == [True] * 4


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


def test_a_link_of_a_rig_that_is_not_here_opens_once_it_is_dropped(
    tab: Any, new_tab: Callable[..., Any], studio_address: str, shared_rig: Callable[[str], Path]
) -> None:
    fox = shared_rig("khronos_fox/Fox.glb").read_bytes()
    # The same rig in other bytes: four blanks more in its JSON, so that no test has given it.
    whole, size = struct.unpack_from("<I", fox, 8)[0], struct.unpack_from("<I", fox, 12)[0]
    fox = fox[:8] + struct.pack("<II", whole + 4, size + 4) + fox[16:]
    fox = fox[: 20 + size] + b"    " + fox[20 + size :]
    wanted = tab.document
    wanted["creature"]["rig"] = f"upload:{hashlib.sha256(fox).hexdigest()}"
    wanted["creature"]["height"] = 0.8
    wanted["path"] = [[1, 2]]
    text = base64.urlsafe_b64encode(json.dumps(wanted).encode()).decode().rstrip("=")
    tab.page.close()
    opened = new_tab(f"{studio_address}#{text}")
    opened.until(lambda: "drop its file on the page" in opened.words, "what is missing is told")
    drop_file(opened, "Fox.glb", fox)
    opened.until(lambda: opened.document == wanted, "the link opens after all")


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
