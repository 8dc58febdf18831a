"""What a person's hands do on the page, and where things on it are."""

from __future__ import annotations

import base64
import math
from typing import Any

import numpy as np

# Files dropped from the desktop, anywhere on the page.
DROP = """
(files) => {
  const dataTransfer = new DataTransfer();
  for (const [name, content] of files) {
    const bytes = Uint8Array.from(atob(content), (letter) => letter.charCodeAt(0));
    dataTransfer.items.add(new File([bytes], name));
  }
  for (const kind of ["dragover", "drop"]) {
    const event = new DragEvent(kind, { dataTransfer, bubbles: true, cancelable: true });
    document.querySelector("#scene").dispatchEvent(event);
  }
}
"""


def drop_file(tab: Any, name: str, content: bytes) -> None:
    """Drop a file on the scene."""
    drop_files(tab, {name: content})


def drop_files(tab: Any, files: dict[str, bytes]) -> None:
    """Drop files on the scene, all at once."""
    listed = [[name, base64.b64encode(content).decode()] for name, content in files.items()]
    tab.page.evaluate(DROP, listed)


def name_of(tab: Any, foot: int) -> str:
    return str(tab.ask(f"polypod.creature.feet[{foot}].name"))


def in_use(tab: Any, foot: int) -> tuple[float, float]:
    """Return the start and extent that a foot goes by now."""
    start, extent = tab.ask(
        f"[polypod.frame.focus.feet[{foot}].start, polypod.frame.focus.feet[{foot}].extent]"
    )
    return start, extent


def turn_handle(tab: Any, foot: int, part: str, cycles: float, *, free: bool = True) -> None:
    """Drag a handle of a wheel round its middle; `free`: with Alt, which lets go of snapping."""
    name = name_of(tab, foot)
    handle = tab.slider(f"{name} {part}")
    handle.scroll_into_view_if_needed()
    wheel = tab.page.get_by_role("group", name=f"{name} wheel", exact=True).bounding_box()
    middle = (wheel["x"] + wheel["width"] / 2, wheel["y"] + wheel["height"] / 2)
    if part == "whole swing":
        # Its middle may be off the sector: halfway along the sector is on it.
        start, extent = in_use(tab, foot)
        angle = 2.0 * math.pi * (start + extent / 2.0)
        x, y = (0.25 * wheel["width"] * math.sin(angle), -0.25 * wheel["width"] * math.cos(angle))
    else:
        box = handle.bounding_box()
        x = box["x"] + box["width"] / 2 - middle[0]
        y = box["y"] + box["height"] / 2 - middle[1]
    mouse = tab.page.mouse
    if free:
        tab.page.keyboard.down("Alt")
    mouse.move(middle[0] + x, middle[1] + y)
    mouse.down()
    for i in range(1, 9):
        turn = 2.0 * math.pi * cycles * i / 8.0
        cosine, sine = math.cos(turn), math.sin(turn)
        mouse.move(middle[0] + x * cosine - y * sine, middle[1] + x * sine + y * cosine)
    mouse.up()
    if free:
        tab.page.keyboard.up("Alt")


def drag_by(tab: Any, element: Any, across: float, down: float) -> None:
    """Drag something of the page by so many pixels."""
    element.scroll_into_view_if_needed()
    box = element.bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    tab.page.mouse.move(x, y)
    tab.page.mouse.down()
    for i in range(1, 9):
        tab.page.mouse.move(x + across * i / 8, y + down * i / 8)
    tab.page.mouse.up()


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


def centre(tab: Any) -> np.ndarray:
    """Return where the body of the creature in focus is, world, m."""
    return np.array(tab.ask("Array.from(polypod.frame.herds[0].body.slice(4, 7))"))


def beside(place: Any, left: float, up: float, ahead: float) -> np.ndarray:
    """Return a place that lies so far from another one along x, y and z, m."""
    return np.asarray(place) + np.array([left, up, ahead])


def pixels(tab: Any, place: Any) -> tuple[float, float]:
    """Return where a place of the world is on the page."""
    x, y = tab.page.evaluate("(p) => polypod.scene.pixelsOf(p)", [float(v) for v in place])
    return x, y


def drag(tab: Any, begin: tuple[float, float], end: tuple[float, float]) -> None:
    """Drag from a place of the page to another, as slowly as a hand."""
    mouse = tab.page.mouse
    mouse.move(*begin)
    mouse.down()
    for i in range(1, 7):
        share = i / 6
        mouse.move(begin[0] + share * (end[0] - begin[0]), begin[1] + share * (end[1] - begin[1]))
        tab.page.wait_for_timeout(40)
    mouse.up()
