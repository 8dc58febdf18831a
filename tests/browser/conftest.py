"""The studio in a browser, as a person has it: found by role and label, driven by mouse and keys.

Pictures of what was seen are kept in out/browser. Where there is no browser these tests are
skipped; POLYPOD_CHROMIUM names one.
"""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))

from chromium import FLAGS

PICTURES = Path(__file__).parents[2] / "out" / "browser"
CHROMIUM = Path(os.environ.get("POLYPOD_CHROMIUM", "/usr/bin/chromium"))
START = 400.0  # s: kernels may have to be compiled
READY = "Boolean(window.polypod?.document && polypod.creature && polypod.tape)"
PATIENCE = 30.0  # s: a machine without a GPU draws a few frames a second


class Tab:
    """A page of the studio, and what it knows."""

    def __init__(self, page: Any) -> None:
        self.page = page

    def ask(self, expression: str) -> Any:
        """Return what an expression of the page gives."""
        return self.page.evaluate(expression)

    @property
    def document(self) -> dict[str, Any]:
        """What is asked for, as the page was told last."""
        return json.loads(self.ask("JSON.stringify(polypod.document)"))

    @property
    def words(self) -> str:
        """What the page says to its user now."""
        return self.page.locator("#words").text_content()

    def open_panel(self, name: str) -> None:
        self.page.get_by_role("tab", name=name).click()

    def button(self, name: str) -> Any:
        return self.page.get_by_role("button", name=name, exact=True)

    def box(self, name: str) -> Any:
        return self.page.get_by_role("spinbutton", name=name, exact=True)

    def slider(self, name: str) -> Any:
        return self.page.get_by_role("slider", name=name, exact=True)

    def type_into(self, name: str, text: str) -> None:
        self.box(name).fill(text)
        self.box(name).press("Enter")

    def until(self, true: Callable[[], Any], what: str, seconds: float = PATIENCE) -> Any:
        """Wait for something to become true, and return it."""
        end = time.monotonic() + seconds
        while True:
            value = true()
            if value:
                return value
            if time.monotonic() > end:
                raise AssertionError(f"not within {seconds:g} s: {what}; it says {self.words!r}")
            self.page.wait_for_timeout(50)

    def until_drawn(self) -> None:
        """Wait until all that has happened is in the picture, while time stands."""
        self.until(lambda: self.ask("polypod.scene.owed <= 0"), "it is drawn")

    def leave(self) -> None:
        """Take the focus off everything, so that keys are for the page."""
        self.ask("document.activeElement.blur()")

    def keep(self, name: str) -> None:
        """Keep a picture of the page."""
        PICTURES.mkdir(parents=True, exist_ok=True)
        self.page.screenshot(path=PICTURES / f"{name}.png")

    def download(self, press: Callable[[], Any]) -> tuple[str, bytes]:
        """Return name and bytes of the file that pressing something gives."""
        with self.page.expect_download(timeout=1000 * PATIENCE) as found:
            press()
        return found.value.suggested_filename, Path(found.value.path()).read_bytes()


def _address(process: subprocess.Popen[str]) -> str:
    said = ""
    end = time.monotonic() + START
    assert process.stdout is not None
    for line in process.stdout:
        said += line
        found = re.search(r"http://127\.0\.0\.1:\d+/", line)
        if found:
            return found[0]
        if time.monotonic() > end:
            break
    raise AssertionError(f"the studio did not start: {said}")


class Studio:
    """A studio in a process of its own, which may end and start again at its address."""

    def __init__(self) -> None:
        self.port = "0"
        self.process: subprocess.Popen[str] | None = None

    def start(self) -> str:
        """Start it, and return its address."""
        words = [sys.executable, "-m", "polypod", "studio", "--no-browser", "--port", self.port]
        self.process = subprocess.Popen(
            words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, bufsize=1
        )
        address = _address(self.process)
        self.port = address.rstrip("/").rsplit(":", 1)[1]
        return address

    def end(self) -> None:
        if self.process is not None:
            self.process.terminate()
            self.process.wait(timeout=20)
            self.process = None


@pytest.fixture(scope="session")
def studio_address() -> Iterator[str]:
    """Start the studio for all tests of the session, and return its address."""
    pytest.importorskip("playwright", reason="the browser's driver is not installed")
    pytest.importorskip("nicegui", reason='the studio needs pip install "polypod[studio]"')
    if not CHROMIUM.is_file():
        pytest.skip(f"there is no browser at {CHROMIUM}; set POLYPOD_CHROMIUM")
    studio = Studio()
    try:
        yield studio.start()
    finally:
        studio.end()


@pytest.fixture
def own_studio(browser: Any) -> Iterator[tuple[Studio, Tab]]:
    """Return a studio of the test's own with a page of it; the page may fail to reach it."""
    studio = Studio()
    try:
        address = studio.start()
        context = browser.new_context(viewport={"width": 1280, "height": 720})
        page = context.new_page()
        page.goto(address)
        tab = Tab(page)
        tab.until(lambda: tab.ask(READY), "the page is there")
        yield studio, tab
        context.close()
    finally:
        studio.end()


@pytest.fixture(scope="session")
def browser(studio_address: str) -> Iterator[Any]:
    from playwright.sync_api import sync_playwright

    with sync_playwright() as driver:
        chromium = driver.chromium.launch(executable_path=str(CHROMIUM), args=FLAGS)
        yield chromium
        chromium.close()


@pytest.fixture
def new_tab(browser: Any, studio_address: str) -> Iterator[Callable[..., Tab]]:
    """Return what opens a page of the studio; at the end none may have failed or looked outside."""
    contexts: list[Any] = []
    faults: list[str] = []

    def open_tab(address: str = studio_address, width: int = 1280, height: int = 720) -> Tab:
        size = {"width": width, "height": height}
        context = browser.new_context(viewport=size, accept_downloads=True)
        contexts.append(context)
        context.grant_permissions(["clipboard-read", "clipboard-write"])
        page = context.new_page()
        page.set_default_timeout(1000 * PATIENCE)
        page.on("console", lambda said: _hear(said, faults))
        page.on("pageerror", lambda error: faults.append(str(error)))
        page.on("request", lambda request: _judge(request.url, studio_address, faults))
        page.goto(address)
        tab = Tab(page)
        tab.until(lambda: tab.ask(READY), "the page is there")
        return tab

    yield open_tab
    for context in contexts:
        context.close()
    assert faults == []


def _hear(said: Any, faults: list[str]) -> None:
    # A refused upload is an answer, though the browser calls it an error.
    if said.type == "error" and "status of 422" not in said.text:
        faults.append(said.text)


def _judge(url: str, home: str, faults: list[str]) -> None:
    if not url.startswith((home, "blob:", "data:", home.replace("http", "ws"))):
        faults.append(f"it asks for {url}")


@pytest.fixture
def tab(new_tab: Callable[..., Tab]) -> Tab:
    """Return a page with the spider on flat ground, playing, as the studio starts."""
    opened = new_tab()
    opened.ask(f"polypod.send({{do: 'open', document: {json.dumps(FRESH)}}})")
    opened.ask("polypod.send({do: 'clock', playing: true, rate: 1})")
    opened.ask("polypod.send({do: 'restart'})")
    walking = "polypod.creature.name === 'spider' && Boolean(polypod.frame)"
    opened.until(lambda: opened.ask(walking), "the spider walks")
    return opened


FRESH = {
    "creature": {
        "rig": "spider", "leg": None, "spine": None, "forward": None, "height": None,
        "body_height": None, "limit": None,
    },
    "crowd": [],
    "command": {
        "speed": None, "heading": 0.0, "travel": 0.0, "step_height": None, "body_height": None,
        "stance_width": 1.0, "period": None, "duty": None, "blend_cycles": 1.0,
    },
    "gait": None,
    "spacing": [],
    "settings": {
        "spine": 1.0, "spine_yaw": 1.0, "spine_flexion": 1.0, "gaze": 1.0, "tail": 1.0,
        "bounce": 1.0, "nod": 1.0, "sway": 1.0,
    },
    "path": [],
    "terrain": None,
    "obstacle": [],
}  # fmt: skip
