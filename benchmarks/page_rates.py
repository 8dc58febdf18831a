"""How fast the studio is, driven as a person drives it, in headless Chromium.

    python benchmarks/page_rates.py --crowds one mixed --drags 30

Serves a studio on a free port, opens it and has walk: one spider, 100 spiders, and 200 creatures of
mixed kinds. One row a crowd: share of real time that the simulation keeps; frames made by it,
received by the page and drawn, a second (the server sends what the page receives: at most three
are under way); bytes per creature and frame, with the overlays that a new page shows; and how long
it takes from a move of the mouse, with the handle of the body height's slider held, to the arrival
of the first frame that was computed with it, median and 95th percentile. `move` counts from the
browser's stamp on the mouse's event, `order` from when the page got round to it and sent: what lies
between is the page at work on its picture. `drawn` is from the move to the first picture of that
frame. `wheel` is `move` for the handle of a gait wheel: its first frame is one in which a foot's
swing lasts longer or shorter. Beside it the cores that the server and Chromium kept busy, and the
machine's load: figures from a machine on which others work tell little.
"""

from __future__ import annotations

import argparse
import cmath
import os
import re
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from chromium import FLAGS
from playwright.sync_api import Page, sync_playwright

KINDS = ("wolf", "ant", "biped", "crab")
CROWDS: dict[str, list[dict[str, Any]]] = {
    "one": [],
    "herd": [{"rig": "spider", "count": 99}],
    "mixed": [{"rig": "spider", "count": 39}, *({"rig": rig, "count": 40} for rig in KINDS)],
}
SCREEN = {"width": 1280, "height": 720}
PATIENCE = 240.0  # s: a cold start compiles
SETTLE = 3.0  # s after a crowd has come, before anything is measured
STROKE = 30  # pixels of a drag
THUMB = 16  # pixels of a slider's handle
SLIDER = "Body height"
ROUND = 0.06  # cycles of a drag on a wheel
HANDLE = re.compile(" swing finish$")

# Times, ms, of what one drag does: the mouse's event, the order, the frame, the picture. The frame
# that was computed with a body height carries it; a gait is blended to, and begins to at once.
WATCH = """() => {
  const { polypod } = window;
  const drags = window.drags = [];
  let moved = 0;
  const move = "onpointerrawupdate" in window ? "pointerrawupdate" : "pointermove";
  window.addEventListener(move, (event) => { moved = event.timeStamp; }, true);
  const effect = ({ at, to }) => {
    if (at[0] === "command") {
      const value = Math.fround(to);
      return ({ focus }) => Math.abs(focus.preferredHeight - value) < 1e-6;
    }
    const before = polypod.frame.focus.feet.map(({ extent }) => extent);
    return ({ focus }) => focus.feet.some(({ extent }, k) => Math.abs(extent - before[k]) > 1e-5);
  };
  const send = polypod.link.send.bind(polypod.link);
  polypod.link.send = (order) => {
    if (order.do === "edit") drags.push({ moved, sent: performance.now(), shows: effect(order) });
    return send(order);
  };
  polypod.on("frame", (frame) => {
    const [drag] = drags;
    if (!drag || drag.frame || !drag.shows(frame)) return;
    drag.frame = performance.now();
    const look = () => {
      if (polypod.scene.playback.to?.time >= frame.time) drag.drawn = performance.now();
      else requestAnimationFrame(look);
    };
    requestAnimationFrame(look);
  });
}"""
FOUND = """() => {
  const [{ moved, sent, frame, drawn }] = window.drags;
  return { moved, sent, frame, drawn };
}"""
HEAD = """\
            of real frames      a second   bytes  move,      order,     drawn,     wheel,
crowd     n    time   made   recv  drawn of each  ms   95 %  ms   95 %  ms   95 %  ms   95 %  cores
"""
COUNT = """() => {
  const { link, scene, frame } = window.polypod;
  return [performance.now() / 1000, frame.number, link.frames, scene.drawn, link.received];
}"""
SHARES = """() => {
  window.unheard?.();
  window.shares = [];
  window.unheard = window.polypod.on("clock", ({ behind }) => window.shares.push(behind));
}"""


class Row(NamedTuple):
    """What one crowd gave; delays [drags, 3] of frames from move and order, of pictures, ms."""

    creatures: int
    share: float
    rates: np.ndarray[Any, Any]  # frames made, received and drawn a second
    size: float  # bytes per creature and frame
    cores: tuple[float, float]  # of the server and of Chromium
    delays: np.ndarray[Any, Any]
    wheel: np.ndarray[Any, Any]  # [drags] ms
    load: float


@contextmanager
def served() -> Iterator[tuple[str, int]]:
    """Serve a studio; the address and the process's number."""
    command = [sys.executable, "-m", "polypod", "studio", "--no-browser", "--port", "0"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as server:
        try:
            assert server.stdout is not None
            found = re.search(r"http://\S+", server.stdout.readline())
            if found is None:
                raise SystemExit("the studio did not begin")
            yield found[0], server.pid
        finally:
            server.terminate()


@contextmanager
def opened(address: str, chromium: str) -> Iterator[Page]:
    """Open the page in a fresh Chromium."""
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=chromium, args=FLAGS)
        try:
            page = browser.new_page(viewport=SCREEN)
            page.goto(address)
            wait(page, "Boolean(window.polypod?.frame)")
            page.get_by_role("tab", name="Body").click()
            page.evaluate(WATCH)
            yield page
        finally:
            browser.close()


def measure(page: Page, crowd: str, seconds: float, drags: int, server: int) -> Row:
    """Have a crowd walk, and measure it; `server` is the process's number."""
    kinds = CROWDS[crowd]
    page.evaluate(
        """async (crowd) => {
          const { polypod } = window;
          const document = structuredClone(polypod.document);
          Object.assign(document, { crowd });
          document.command.body_height = null;
          await polypod.send({ do: "open", document });
        }""",
        kinds,
    )
    wait(page, f"window.polypod.frame.herds.length === {1 + len(kinds)}")
    time.sleep(SETTLE)
    page.evaluate(SHARES)
    before, work, began = np.array(page.evaluate(COUNT)), worked(server), time.perf_counter()
    time.sleep(seconds)
    after, spent = np.array(page.evaluate(COUNT)), time.perf_counter() - began
    cores = tuple(np.subtract(worked(server), work) / spent)
    passed = after - before
    creatures = 1 + sum(kind["count"] for kind in kinds)
    share = float(np.mean(page.evaluate("() => window.shares")))
    delays = np.array([drag(page, n) for n in range(drags)])
    page.get_by_role("tab", name="Gait").click()
    wheel = np.array([turn(page, n) for n in range(drags)])
    page.get_by_role("tab", name="Body").click()
    return Row(
        creatures, share, passed[1:4] / passed[0], passed[4] / passed[2] / creatures,
        cores, delays, wheel, os.getloadavg()[0],
    )  # fmt: skip


def drag(page: Page, number: int) -> list[float]:
    """Drag the slider, to and fro by turns; how long frame and picture took, ms."""
    slider = page.get_by_role("slider", name=SLIDER)
    slider.scroll_into_view_if_needed()
    left, y, width, share = slider.evaluate(
        "(e) => { const box = e.getBoundingClientRect(); return [box.x, box.y + box.height / 2, "
        "box.width, (e.value - e.min) / (e.max - e.min)]; }"
    )
    x = left + THUMB / 2 + share * (width - THUMB)
    found = hold(page, (x, y), (x - STROKE if share > 0.5 else x + STROKE, y), number)
    return [
        found["frame"] - found["moved"], found["frame"] - found["sent"],
        found["drawn"] - found["moved"],
    ]  # fmt: skip


def turn(page: Page, number: int) -> float:
    """Drag the handle of a wheel round it, to and fro by turns; how long its frame took, ms."""
    handle = page.get_by_role("slider", name=HANDLE).first
    handle.scroll_into_view_if_needed()
    box = handle.bounding_box()
    wheel = handle.locator("xpath=ancestor::*[local-name()='svg']").bounding_box()
    assert box is not None
    assert wheel is not None
    middle = complex(wheel["x"] + wheel["width"] / 2, wheel["y"] + wheel["height"] / 2)
    begin = complex(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    way = cmath.exp(2j * cmath.pi * (ROUND if number % 2 else -ROUND))
    end = middle + (begin - middle) * way
    found = hold(page, (begin.real, begin.imag), (end.real, end.imag), number)
    # Its blend ends before the next.
    page.wait_for_timeout(600)
    return float(found["frame"] - found["moved"])


def hold(
    page: Page, begin: tuple[float, float], end: tuple[float, float], number: int
) -> dict[str, float]:
    """Press at a place, move to another, let go; the times of what that did, ms."""
    page.mouse.move(*begin)
    page.mouse.down()
    # Whatever pressing it has moved is not what is measured; each begins elsewhere in a frame.
    page.wait_for_timeout(300 + 37 * (number % 10))
    page.evaluate("() => { drags.length = 0; }")
    page.mouse.move(*end)
    wait(page, "Boolean(drags[0]?.drawn)")
    found: dict[str, float] = page.evaluate(FOUND)
    page.mouse.up()
    return found


def wait(page: Page, condition: str) -> None:
    """Wait until a condition holds on the page, which lets no text be evaluated by itself."""
    end = time.monotonic() + PATIENCE
    while not page.evaluate(condition):
        if time.monotonic() > end:
            raise SystemExit(f"it never came to this: {condition}")
        time.sleep(0.05)


def worked(server: int) -> tuple[float, float]:
    """Return the seconds of work that the server and our Chromium have done (Linux)."""
    done = [0.0, 0.0]
    for entry in Path("/proc").iterdir():
        fields = _fields(entry.name) if entry.name.isdigit() else []
        if not fields:
            continue
        seconds = (int(fields[12]) + int(fields[13])) / os.sysconf("SC_CLK_TCK")
        if int(entry.name) == server:
            done[0] += seconds
        elif "chrom" in fields[0] and _is_ours(fields):
            done[1] += seconds
    return done[0], done[1]


def _is_ours(fields: list[str]) -> bool:
    """Return whether we began a process, or began what began it."""
    while fields and int(fields[2]) > 1:
        if int(fields[2]) == os.getpid():
            return True
        fields = _fields(fields[2])
    return False


def _fields(process: str) -> list[str]:
    """Return a process's name, state, parent and so on, as the kernel lists them."""
    try:
        name, rest = Path("/proc", process, "stat").read_text().split("(", 1)[1].rsplit(")", 1)
    except OSError:
        return []
    return [name, *rest.split()]


def show(crowd: str, row: Row) -> None:
    made, received, drawn = row.rates
    print(
        f"{crowd:6} {row.creatures:4} {100 * row.share:5.0f} % "
        f"{made:6.1f} {received:6.1f} {drawn:6.1f} {row.size:7.0f}  "
        + "  ".join(
            f"{np.median(column):4.0f} {np.percentile(column, 95):4.0f}"
            for column in (*row.delays.T, row.wheel)
        )
        + f"  {row.cores[0]:.1f}+{row.cores[1]:.1f}  load {row.load:.0f}",
        flush=True,
    )


def main() -> None:
    parser = argparse.ArgumentParser(description="How fast the studio is, in Chromium.")
    parser.add_argument("--crowds", nargs="+", choices=CROWDS, default=list(CROWDS))
    parser.add_argument("--seconds", type=float, default=10.0, help="for which rates are counted")
    parser.add_argument("--drags", type=int, default=30)
    parser.add_argument("--chromium", default=shutil.which("chromium") or "chromium")
    given = parser.parse_args()
    with served() as (address, server), opened(address, given.chromium) as page:
        print(f"{os.cpu_count()} cores; load before {os.getloadavg()[0]:.1f}")
        print(HEAD, end="")
        for crowd in given.crowds:
            show(crowd, measure(page, crowd, given.seconds, given.drags, server))


if __name__ == "__main__":
    main()
