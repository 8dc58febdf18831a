"""The websocket: who drives, what is taken, what waits and what is dropped."""

from __future__ import annotations

import asyncio
import json
import struct
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from starlette.websockets import WebSocketDisconnect

from polypod.studio.outbox import Outbox, Telling
from studio.server import HOME, TOKEN, Served


def until(true: Callable[[], bool]) -> None:
    """Wait for another thread, at most five seconds."""
    for _ in range(500):
        if true():
            return
        time.sleep(0.01)
    raise AssertionError("it did not happen")


def frame_number(content: bytes) -> int:
    return int(struct.unpack_from("<I", content, 4)[0])


def ask(tab: Any, **order: Any) -> dict[str, Any]:
    """Send an order and return the next message."""
    tab.send_json(order)
    return dict(tab.receive_json())


def test_the_first_tab_drives_and_others_are_told_so(studio: Served) -> None:
    with studio.tab() as first, studio.tab() as second:
        assert (first.drives, second.drives) == (True, False)
        answer = ask(second, do="undo", id=1)
        assert answer["is"] == "refused"
        assert answer["id"] == 1
        assert "another tab drives" in answer["why"]
        assert studio.runner.orders == []
        assert ask(first, do="undo", id=2) == {"is": "done", "id": 2}
        assert studio.runner.orders == [{"do": "undo"}]
        # Watching, seeing and acknowledging are for all.
        assert ask(second, do="watch", creature=0, id=3) == {"is": "done", "id": 3}
        assert ask(second, do="see", overlays=["cells"], id=4) == {"is": "done", "id": 4}
        assert ask(second, do="ack", frame=7, id=5) == {"is": "done", "id": 5}


def test_a_tab_that_comes_while_time_stands_sees_where_everything_is(studio: Served) -> None:
    studio.runner.last = struct.pack("<II", 1, 7)
    with studio.tab() as tab:
        assert frame_number(tab.receive_bytes()) == 7


def test_another_tab_takes_over(studio: Served) -> None:
    with studio.tab() as first, studio.tab() as second:
        second.send_json({"do": "drive", "id": 1})
        assert first.receive_json() == {"is": "role", "drives": False}
        assert second.receive_json() == {"is": "role", "drives": True}
        assert second.receive_json() == {"is": "done", "id": 1}
        assert ask(first, do="restart", id=2)["is"] == "refused"
        assert ask(second, do="restart", id=3)["is"] == "done"
        # Who drives already hears nothing new.
        assert ask(second, do="drive", id=4) == {"is": "done", "id": 4}


def test_when_the_driver_leaves_the_oldest_other_drives(studio: Served) -> None:
    with studio.tab() as second_to_be, studio.tab() as driver, studio.tab() as youngest:
        driver.send_json({"do": "drive"})
        assert second_to_be.receive_json() == {"is": "role", "drives": False}
        assert driver.receive_json() == {"is": "role", "drives": True}
        driver.close()
        assert second_to_be.receive_json() == {"is": "role", "drives": True}
        assert ask(youngest, do="undo", id=1)["is"] == "refused"
    until(lambda: studio.runner.listeners == [])
    with studio.tab() as alone:
        assert alone.drives


def test_a_runners_refusal_reaches_the_tab_that_asked(studio: Served) -> None:
    with studio.tab() as first, studio.tab() as second:
        studio.runner.refuses = "speed: must be less"
        edit = {"do": "edit", "at": ["command", "speed"], "to": 1e9}
        assert ask(first, **edit, id=9) == {
            "is": "refused", "id": 9, "why": "speed: must be less",
        }  # fmt: skip
        # Without an id only a refusal is worth a message.
        assert ask(first, **edit) == {"is": "refused", "why": "speed: must be less"}
        studio.runner.refuses = None
        first.send_json(edit)
        studio.runner.tell("text", {"is": "clock"})
        assert first.receive_json() == {"is": "clock"}
        assert second.receive_json() == {"is": "clock"}


@pytest.mark.parametrize(
    "text",
    [
        "", "{", "[]", "3", "null", '"undo"', "{}", '{"do": 3}', '{"do": "fly"}', '{"do": null}',
        '{"do": "edit", "at": [], "to": NaN}', '{"do": "edit", "to": Infinity}',
        '{"do": "undo", "do": "redo"}', '{"do": "undo", "id": "x"}', '{"do": "undo", "id": true}',
        '{"do": "undo", "extra": 1}', '{"do": "ack"}', '{"do": "ack", "frame": -1}',
        '{"do": "ack", "frame": 1.5}', '{"do": "ack", "frame": true}', '{"do": "see"}',
        '{"do": "see", "overlays": ["walls"]}', '{"do": "see", "overlays": [["cells"]]}',
        '{"do": "see", "overlays": "cells"}', '{"do": "drive", "to": 1}',
        '{"do": "clock", "rate": 1e999}', '{"do": "push", "velocity": [1, 2]}', "[" * 60_000,
        json.dumps({"do": "undo", "x": "x" * 70_000}),
    ],
    ids=lambda text: text[:40],
)  # fmt: skip
def test_what_cannot_be_understood_is_refused_with_a_word(studio: Served, text: str) -> None:
    with studio.tab() as tab:
        tab.send_text(text)
        answer = tab.receive_json()
        assert answer["is"] == "refused"
        assert 5 < len(answer["why"]) < 300
        # The tab goes on.
        assert ask(tab, do="undo", id=1) == {"is": "done", "id": 1}
    assert studio.runner.orders == [{"do": "undo"}]


# No deadline: a busy machine is no fault of the studio.
@settings(deadline=None)
@given(st.text() | st.binary())
def test_any_message_is_refused_or_an_order(content: str | bytes) -> None:
    from studio.server import served

    with served() as studio, studio.tab() as tab:
        if isinstance(content, bytes):
            tab.send_bytes(content)
        else:
            tab.send_text(content)
        assert tab.receive_json()["is"] == "refused"
        assert ask(tab, do="redo", id=1) == {"is": "done", "id": 1}


def test_too_many_faults_close_the_connection(studio: Served) -> None:
    with studio.tab() as tab:
        for _ in range(21):
            tab.send_bytes(b"\x01")
        for _ in range(21):
            assert "binary" in tab.receive_json()["why"]
        with pytest.raises(WebSocketDisconnect) as closed:
            tab.receive_json()
        assert closed.value.code == 1008
        assert "understood" in closed.value.reason


def test_ten_thousand_messages_close_the_connection_and_change_nothing(studio: Served) -> None:
    with studio.tab() as watcher, studio.tab() as tab:
        for _ in range(10_000):
            tab.send_text('{"do":"ack","frame":1}')
        message = tab.receive_json()
        assert message["is"] == "refused"
        assert "200 messages a second" in message["why"]
        with pytest.raises(WebSocketDisconnect) as closed:
            tab.receive_json()
        assert closed.value.code == 1008
        # The other tab has noticed nothing.
        assert ask(watcher, do="undo", id=1) == {"is": "done", "id": 1}
    assert studio.runner.orders == [{"do": "undo"}]


def test_orders_that_nobody_answers_do_not_pile_up(studio: Served, monkeypatch: Any) -> None:
    monkeypatch.setattr("polypod.studio.link.MOST_ORDERS", 3)
    studio.runner.silent = True
    with studio.tab() as tab:
        for _ in range(3):
            tab.send_json({"do": "undo"})
        assert "busy" in ask(tab, do="undo", id=4)["why"]
    assert len(studio.runner.orders) == 3


def test_three_frames_are_under_way_and_newer_ones_replace_those_that_wait(studio: Served) -> None:
    with studio.tab() as tab:
        for number in range(1, 4):
            studio.runner.frame(number)
            assert frame_number(tab.receive_bytes()) == number
        for number in range(4, 100):
            studio.runner.frame(number)
        studio.runner.tell("text", {"is": "clock", "time": 1.0})
        # Messages pass frames that wait.
        assert tab.receive_json()["time"] == 1.0
        tab.send_json({"do": "ack", "frame": 1})
        assert frame_number(tab.receive_bytes()) == 99
        # An acknowledgement counts for the frames before it; one of a frame never sent for none.
        tab.send_json({"do": "ack", "frame": 50})
        tab.send_json({"do": "ack", "frame": 99})
        for number in (100, 101, 102):
            studio.runner.frame(number)
            assert frame_number(tab.receive_bytes()) == number
        studio.runner.frame(103)
        assert ask(tab, do="undo", id=1)["is"] == "done"


def test_a_slow_tab_does_not_hold_up_another(studio: Served) -> None:
    with studio.tab() as slow, studio.tab() as quick:
        for number in range(1, 51):
            studio.runner.frame(number)
            assert frame_number(quick.receive_bytes()) == number
            quick.send_json({"do": "ack", "frame": number})
        assert [frame_number(slow.receive_bytes()) for _ in range(3)] == [1, 2, 3]


def test_overlays_go_to_those_who_wish_to_see_them(studio: Served) -> None:
    with studio.tab() as first:
        with studio.tab() as second:
            assert ask(first, do="see", overlays=["cells", "hull"], id=1)["is"] == "done"
            assert ask(second, do="see", overlays=["paths"], id=1)["is"] == "done"
            assert studio.runner.seen[-1] == {"cells", "hull", "paths"}
            studio.runner.tell("arrays", b"cells", "cells")
            studio.runner.tell("arrays", b"paths", "paths")
            assert first.receive_bytes() == b"cells"
            assert second.receive_bytes() == b"paths"
            assert ask(first, do="see", overlays=[], id=2)["is"] == "done"
            studio.runner.tell("arrays", b"cells", "cells")
            assert ask(first, do="undo", id=3)["is"] == "done"
        until(lambda: studio.runner.seen[-1] == frozenset())


def test_a_welcome_that_comes_late_says_who_drives(studio: Served) -> None:
    with studio.tab() as first, studio.tab() as second:
        studio.runner.tell("text", {"is": "welcome", "fps": 60})
        assert first.receive_json() == {"is": "welcome", "fps": 60, "drives": True}
        assert second.receive_json() == {"is": "welcome", "fps": 60, "drives": False}


def test_there_is_a_most_of_tabs(studio: Served, monkeypatch: Any) -> None:
    monkeypatch.setattr("polypod.studio.link.MOST_TABS", 1)
    with studio.tab(), pytest.raises(WebSocketDisconnect) as closed, studio.tab():
        pass
    assert closed.value.code == 1013


@pytest.mark.parametrize("taken", [0, 1, 2], ids=["greeting", "its end", "frame"])
def test_a_server_that_closes_a_connection_itself_is_no_fault(studio: Served, taken: int) -> None:
    """As uvicorn does when it ends: it says so of what is sent later, before any disconnect."""
    studio.runner.last = struct.pack("<II", 1, 7)
    scope = {
        "type": "websocket", "path": "/link", "query_string": f"token={TOKEN}".encode(),
        "headers": [(b"host", HOME[7:].encode()), (b"origin", HOME.encode())],
        "subprotocols": [], "extensions": {},
    }  # fmt: skip
    sent: list[str] = []

    async def receive() -> dict[str, Any]:
        if not sent:
            return {"type": "websocket.connect"}
        await asyncio.Event().wait()
        raise AssertionError("it never ends")

    async def send(message: Any) -> None:
        if len(sent) > taken:
            raise RuntimeError("Unexpected ASGI message, after sending 'websocket.close'.")
        sent.append(message["type"])

    # The browser's driver may have a loop of its own in this thread.
    with ThreadPoolExecutor(1) as thread:
        thread.submit(asyncio.run, studio.app(scope, receive, send)).result(30.0)
    assert sent == ["websocket.accept", *(taken * ["websocket.send"])]
    with studio.tab() as tab:
        assert tab.drives, "who is gone drives no more"


TELLINGS = st.lists(
    st.tuples(st.sampled_from(["text", "frame", "arrays"]), st.sampled_from(["a", "b"]))
)


@given(TELLINGS, st.booleans())
def test_the_outbox_keeps_messages_in_order_and_the_newest_of_the_rest(
    kinds: list[tuple[str, str]], frames: bool
) -> None:
    outbox = Outbox()
    put = [
        Telling(kind, i, name if kind == "arrays" else "") for i, (kind, name) in enumerate(kinds)
    ]
    for telling in put:
        outbox.put(telling)
    newest = {(t.kind, t.name): t for t in put}
    expected = [
        t
        for t in put
        if t.kind == "text" or (newest[t.kind, t.name] is t and (frames or t.kind != "frame"))
    ]
    taken = []
    while (telling := outbox.take(frames)) is not None:
        taken.append(telling)
    assert taken == expected
    assert outbox.messages == 0
    assert len(outbox) == (0 if frames else ("frame", "") in newest)
