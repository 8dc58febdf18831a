"""What stops somebody who has never seen the page, tried as they would."""

from __future__ import annotations

import base64
import io
import json
import struct
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hands import centre, drop_file
from PIL import Image

from polypod.morphology.builtin import build
from studio.covered_rigs import MAGENTA, covered, framed_png

BENCH = Path(__file__).parents[2] / "examples" / "scenes" / "bench.obj"
LONG = 120.0  # s: a machine that has other things to do

# How wide the pictures of all materials of skins are, 0 where there is none.
PICTURES = """
polypod.scene.scene.children.filter((one) => one.geometry?.getAttribute("joint"))
  .flatMap(({ material }) => material).map((one) => one.map?.image.width ?? 0)
"""
# The view as it is drawn now, as a PNG.
PICTURE = """
async () => {
  const bytes = new Uint8Array(await (await polypod.scene.picture()).arrayBuffer());
  return btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join(""));
}
"""


def judged(tab: Any, words: str) -> None:
    verdict = tab.page.locator(".verdict")
    tab.until(lambda: words in verdict.text_content(), "it is judged", LONG)


def walk(tab: Any, name: str) -> None:
    tab.until(tab.button("Walk it").is_enabled, "it may walk")
    tab.button("Walk it").click()
    tab.until(lambda: tab.ask("polypod.creature.name") == name, "it is there", LONG)


def share_of(tab: Any, colour: tuple[int, int, int]) -> float:
    """Return which share of the view has about the hue of a colour."""
    picture = Image.open(io.BytesIO(base64.b64decode(tab.page.evaluate(PICTURE))))
    seen = np.asarray(picture.convert("RGB"), float)
    seen = seen - seen.mean(axis=2, keepdims=True)
    wanted = np.array(colour, float) - np.mean(colour)
    size = np.linalg.norm(seen, axis=2)
    alike = seen @ wanted > 0.97 * size * np.linalg.norm(wanted)
    return float((alike & (size > 40.0)).mean())


def test_a_creature_has_its_picture_on(tab: Any) -> None:
    before = share_of(tab, MAGENTA)
    drop_file(tab, "painted.glb", covered("wolf", framed_png()))
    judged(tab, "It can walk: 4 legs")
    walk(tab, "painted")
    tab.until(lambda: 32 in tab.ask(PICTURES), "its picture is decoded")
    tab.page.wait_for_timeout(1000)
    tab.keep("visit-painted")
    # Of its vertices' colours, white, nothing would be seen.
    assert before < 1e-4
    assert share_of(tab, MAGENTA) > 0.005


def test_a_broken_picture_stops_nothing(tab: Any) -> None:
    # What says that it is a PNG, and ends.
    drop_file(tab, "torn.glb", covered("wolf", framed_png()[:60]))
    judged(tab, "It can walk: 4 legs")
    walk(tab, "torn")
    tab.until(lambda: tab.ask("Boolean(polypod.scene.creatures.herds[0].arrays)"), "it is drawn")
    assert set(tab.ask(PICTURES)) == {0}


def test_new_ground_is_walked_from_its_beginning(tab: Any) -> None:
    tab.open_panel("World")
    tab.until(lambda: centre(tab)[2] > 1.0, "it has gone a way", LONG)
    choice = tab.page.get_by_role("combobox", name="Ground")
    choice.select_option("stairs")
    tab.button("Make this ground").click()
    tab.until(lambda: abs(centre(tab)[2]) < 0.5, "it stands before the stairs")
    assert tab.document["terrain"]["generator"] == "stairs"
    # Their numbers may change while it is on them.
    tab.until(lambda: centre(tab)[2] > 0.8, "it has gone a way", LONG)
    tab.type_into("rise in m", "0.05")
    tab.button("Make this ground").click()
    tab.until(lambda: tab.document["terrain"]["rise"] == 0.05, "they are lower")
    tab.page.wait_for_timeout(500)
    assert centre(tab)[2] > 0.6


def test_numbers_of_ground_go_back_to_their_defaults(tab: Any) -> None:
    tab.open_panel("World")
    tab.page.get_by_role("combobox", name="Ground").select_option("stairs")
    back = tab.page.get_by_role("button", name="rise: back to default")
    assert back.is_disabled()
    tab.type_into("rise in m", "0.05")
    back.click()
    assert tab.box("rise in m").input_value() == "0.100"
    assert back.is_disabled()


def as_gltf(glb: bytes) -> bytes:
    """Return a GLB as a .gltf that holds everything."""
    size = struct.unpack_from("<I", glb, 12)[0]
    content = json.loads(glb[20 : 20 + size])
    binary = base64.b64encode(glb[28 + size :]).decode()
    content["buffers"][0]["uri"] = f"data:application/octet-stream;base64,{binary}"
    return json.dumps(content).encode()


def test_a_rig_that_was_given_can_be_chosen_again(tab: Any) -> None:
    drop_file(tab, "beast.gltf", as_gltf(build("lizard").glb))
    judged(tab, "It can walk: 4 legs")
    choice = tab.page.get_by_role("combobox", name="Creature")
    choice.select_option("ant")
    judged(tab, "It can walk: 6 legs")
    choice.select_option(label="beast.gltf")
    judged(tab, "It can walk: 4 legs")
    walk(tab, "beast")


@pytest.mark.parametrize(
    ("name", "content", "word"),
    [
        ("empty.glb", b"", "empty.glb is empty."),
        ("notes.txt", b"hello", "notes.txt is no GLB"),
        ("table.glb", b"glTF" + bytes(100), "table.glb: is GLB version 0"),
    ],
)
def test_what_is_no_rig_says_so(tab: Any, name: str, content: bytes, word: str) -> None:
    drop_file(tab, name, content)
    tab.until(lambda: tab.words.startswith(word), "it says why")


def test_who_looks_for_keys_finds_them(tab: Any) -> None:
    tab.button("Keys").click()
    assert tab.page.get_by_role("dialog", name="Keys").is_visible()
    tab.page.keyboard.press("Escape")
    assert not tab.page.get_by_role("dialog", name="Keys").is_visible()


@pytest.mark.parametrize(
    ("names", "short"),
    [
        (["b_LHand_011", "b_RHand_08", "b_LFoot02_018"], ["LHand", "RHand", "LFoot02"]),
        (["Leg_1", "Leg_2"], ["Leg_1", "Leg_2"]),
        (["Left1Foot", "Right1Foot", "Left2Foot"], ["Left1", "Right1", "Left2"]),
        (["Foot.L", "Foot.R"], ["Foot.L", "Foot.R"]),
        (["rig:Left", "rig:Right"], ["Left", "Right"]),
        (["paw", "paw"], ["paw", "paw"]),
    ],
)
def test_feet_are_called_by_what_tells_them_apart(
    tab: Any, names: list[str], short: list[str]
) -> None:
    call = "async (names) => (await import('/page/foot_names.js')).shortNames(names)"
    assert tab.page.evaluate(call, [{"name": name} for name in names]) == short


def test_a_studio_that_is_started_anew_is_taken_up_with(own_studio: Any) -> None:
    studio, tab = own_studio
    drop_file(tab, "beast.glb", build("wolf").glb)
    judged(tab, "It can walk: 4 legs")
    walk(tab, "beast")
    drop_file(tab, "bench.obj", BENCH.read_bytes())
    tab.until(lambda: tab.document["obstacle"], "a mesh stands there")
    tab.open_panel("Body")
    tab.type_into("Speed in m/s", "0.5")
    tab.until(lambda: tab.document["command"]["speed"] == 0.5, "it is slower")
    before = tab.document
    studio.end()
    tab.until(lambda: tab.ask("document.body.classList.contains('lost')"), "it is gone", LONG)
    tab.keep("visit-lost")
    studio.start()
    back = tab.button("Bring it back")
    tab.until(back.is_visible, "the page has found it again", LONG)
    assert tab.ask("polypod.creature.name") == "spider"
    tab.keep("visit-started-anew")
    tab.until(back.is_enabled, "it drives")
    back.click()
    tab.until(lambda: tab.ask("polypod.creature.name") == "beast", "it is back", LONG)
    tab.until(lambda: tab.document == before, "all of it is")
    assert not back.is_visible()
