"""What pictures cost: how fine they are, when there are none, and how soon a hand is followed."""

from __future__ import annotations

import base64
import io
from itertools import pairwise
from typing import Any

import pytest
from hands import drag_slider, turn_handle

# The level after each of `steps` [[ms between pictures, how many], ...], from `level` on.
LEVELS = """([level, steps]) => import("/page/quality.js").then(({ Quality }) => {
  const quality = new Quality(level);
  return steps.map(([interval, count]) => {
    for (let n = 0; n < count; n++) quality.take(interval);
    return quality.level;
  });
})"""
# ms that pictures wait for each other, after so many words on what share of real time is kept.
PAUSES = """(words) => import("/page/quality.js").then(({ Patience }) => {
  const patience = new Patience();
  return words.map(([kept, count]) => {
    for (let n = 0; n < count; n++) patience.take(kept);
    return patience.pause;
  });
})"""
# How often the level changes in ten minutes on a machine that has time for level 2 but not for 1.
CHANGES = """() => import("/page/quality.js").then(({ Quality }) => {
  const quality = new Quality(0);
  const changes = [];
  for (let now = 0; now < 600e3;) {
    const before = quality.level;
    const interval = before < 2 ? 60 : 17;
    now += interval;
    if (quality.take(interval) !== before) changes.push(now / 1000);
  }
  return changes;
})"""
# What comes first of a drag: the order that it gives, or the event that comes with a picture.
ORDER_OF_THINGS = """() => {
  window.things = [];
  const send = polypod.link.send.bind(polypod.link);
  polypod.link.send = (order) => {
    if (order.do === "edit") things.push("order");
    return send(order);
  };
  window.addEventListener("pointermove", ({ buttons }) => {
    if (buttons) things.push("move");
  }, true);
}"""


def drawn(tab: Any) -> int:
    return int(tab.ask("polypod.scene.drawn"))


def stand(tab: Any) -> None:
    """Stop time, and wait until nothing is drawn any more."""
    tab.ask("polypod.send({do: 'clock', playing: false})")

    def still() -> bool:
        before = drawn(tab)
        tab.page.wait_for_timeout(700)
        return drawn(tab) == before

    tab.until(still, "no picture is drawn")


def levels(tab: Any, level: int, *steps: tuple[float, int]) -> list[int]:
    return tab.page.evaluate(LEVELS, [level, [list(step) for step in steps]])


def test_a_machine_with_time_draws_at_the_best_and_stays_there(tab: Any) -> None:
    assert levels(tab, 0, (1000 / 60, 6000)) == [0]
    # A picture that is late now and then is no slow machine.
    assert levels(tab, 0, *[(1000 / 60, 20), (900, 1)] * 20) == [0] * 40
    # A screen of 30 Hz is as it is; nor does a page that was asleep say anything.
    assert levels(tab, 0, (1000 / 30, 3000), (60000, 20)) == [0, 0]


def test_slow_pictures_become_coarser_by_steps_and_finer_when_there_is_time(tab: Any) -> None:
    assert levels(tab, 0, (60, 24), (60, 24), (60, 200), (60, 200)) == [1, 2, 3, 3]
    # There is a second's doubt, and no hurry to go back.
    assert levels(tab, 0, (60, 12)) == [0]
    assert levels(tab, 3, (17, 240)) == [3]
    assert levels(tab, 3, (17, 400), (17, 400), (17, 400), (17, 400)) == [2, 1, 0, 0]
    # Neither too slow nor quick: nothing changes.
    assert levels(tab, 2, (30, 6000)) == [2]


def test_levels_do_not_go_to_and_fro(tab: Any) -> None:
    changes = tab.ask(f"({CHANGES})()")
    assert len(changes) % 2 == 0, "it ends at the level for which there is time"
    assert len(changes) <= 16
    tries = changes[2::2]
    waits = [later - earlier for earlier, later in pairwise(tries)]
    assert all(later > 1.5 * earlier for earlier, later in pairwise(waits))


def test_pictures_wait_where_the_simulation_does_not_keep_up(tab: Any) -> None:
    def pauses(*words: tuple[float, int]) -> list[float]:
        return tab.page.evaluate(PAUSES, [list(word) for word in words])

    assert pauses((1.0, 100), (0.97, 100)) == [0, 0]
    first, most, still, gone = pauses((0.8, 1), (0.8, 20), (0.98, 20), (1.0, 20))
    assert 33 < first < most == still <= 110
    assert gone == 0


def test_nothing_is_drawn_while_nothing_stirs(tab: Any) -> None:
    stand(tab)
    before = drawn(tab)
    for x in range(1000, 1200, 20):
        tab.page.mouse.move(x, 400)
    tab.page.wait_for_timeout(800)
    assert drawn(tab) == before
    tab.page.mouse.move(450, 300)
    tab.page.mouse.wheel(0, 300)
    before = tab.until(lambda: drawn(tab) > before and drawn(tab), "a turn of the wheel is seen")
    stand(tab)
    before = drawn(tab)
    tab.ask("polypod.edit(['command', 'stance_width'], 1.1)")
    tab.until(lambda: drawn(tab) > before, "a change is seen")
    tab.button("Play").click()
    before = drawn(tab)
    tab.until(lambda: drawn(tab) > before + 10, "it is drawn while it walks")


def test_what_stands_still_is_drawn_once_more_finely(tab: Any) -> None:
    size = "(({ canvas: c, painter: p }) => [c.width, c.clientWidth, p.level])(polypod.scene)"
    tab.ask("polypod.scene.painter.quality.level = 3")
    tab.until(lambda: tab.ask(size)[2] == 3, "it is drawn coarsely")
    width, place, _ = tab.ask(size)
    assert width < 0.7 * place
    stand(tab)
    assert tab.ask(size)[:2] == [place, place]
    tab.keep("picture-still")
    tab.button("Play").click()
    tab.until(lambda: tab.ask(size)[0] < 0.9 * place or tab.ask(size)[2] < 2, "it moves smoothly")


def test_a_quality_is_pinned_and_remembered_and_what_is_kept_is_the_best(tab: Any) -> None:
    from PIL import Image

    stand(tab)
    choice = tab.page.get_by_label("Picture quality")
    size = "(({ canvas: c, painter: p }) => [c.width, c.clientWidth, p.level])(polypod.scene)"
    choice.select_option("fast")
    tab.until(lambda: tab.ask(size)[2] == 3, "it is drawn coarsely")
    width, place, _ = tab.ask(size)
    assert width < 0.7 * place
    tab.page.wait_for_timeout(700)
    tab.keep("picture-fast")
    text = tab.ask(
        """(async () => {
          const levels = [];
          const { painter } = polypod.scene;
          const use = painter.use.bind(painter);
          painter.use = (level) => { levels.push(level); use(level); };
          const blob = await polypod.scene.picture();
          painter.use = use;
          const bytes = new Uint8Array(await blob.arrayBuffer());
          return [btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join("")), levels];
        })()"""
    )
    assert text[1][0] == 0
    image = Image.open(io.BytesIO(base64.b64decode(text[0])))
    assert image.width == 2 * place
    assert tab.ask(size) == [width, place, 3]
    tab.page.reload()
    tab.until(lambda: tab.ask("Boolean(window.polypod?.scene && polypod.frame)"), "it is back")
    assert tab.ask(size)[2] == 3
    choice.select_option("best")
    tab.until(lambda: tab.ask(size)[:2] == [place, place], "it is drawn finely")
    assert tab.ask(size)[2] == 0
    tab.page.wait_for_timeout(700)
    tab.keep("picture-best")


def test_a_slider_is_followed_before_the_next_picture_and_is_one_step_of_undo(tab: Any) -> None:
    tab.open_panel("Body")
    tab.ask(f"({ORDER_OF_THINGS})()")
    before = tab.document["command"]["step_height"]
    drag_slider(tab, "Step height", 0.7)
    things = tab.until(lambda: "order" in tab.ask("things") and tab.ask("things"), "it is ordered")
    assert things[0] == "order"
    asked = "Number(document.querySelector('[aria-label=\"Step height\"] input').value)"
    tab.until(
        lambda: tab.document["command"]["step_height"] == pytest.approx(tab.ask(asked)),
        "the last place holds",
    )
    share = "((it) => (it.value - it.min) / (it.max - it.min))"
    found = tab.ask(f"{share}(document.querySelector('[aria-label=\"Step height\"] input'))")
    assert found == pytest.approx(0.7, abs=0.03)
    tab.button("Undo").click()
    tab.until(lambda: tab.document["command"]["step_height"] == before, "one undo takes it back")


def test_a_wheel_is_followed_before_the_next_picture_and_is_one_step_of_undo(tab: Any) -> None:
    tab.open_panel("Gait")
    tab.ask(f"({ORDER_OF_THINGS})()")
    assert tab.document["gait"] is None
    turn_handle(tab, 0, "swing finish", 0.08)
    tab.until(lambda: tab.document["gait"], "a gait is drawn")
    assert tab.ask("things")[0] == "order"
    tab.page.wait_for_timeout(500)
    tab.button("Undo").click()
    tab.until(lambda: tab.document["gait"] is None, "one undo takes it back")
