"""The websocket: orders from every tab to the one simulation, and its frames to all of them.

Several tabs watch and one drives: the first; another takes over by asking; when the driver leaves,
the tab that is here for longest drives. What the simulation tells comes in its own thread, is
handed to the event loop at most once per round, and waits there for each tab.
"""

from __future__ import annotations

import asyncio
import threading
import time
from collections.abc import Awaitable, Callable, Iterator
from contextlib import contextmanager, suppress
from typing import Any

from anyio import create_task_group, to_thread
from starlette.websockets import WebSocket, WebSocketDisconnect

from polypod.errors import PolypodError
from polypod.studio.guard import LARGEST_DOCUMENT, LARGEST_ORDER, RefusalError, parse_order
from polypod.studio.orders import FOR_ALL, ORDERS, judge_order
from polypod.studio.outbox import Outbox, Telling
from polypod.studio.seam import Running
from polypod.studio.tab import MOST_ORDERS, Tab, as_json

SIZES = {do: LARGEST_DOCUMENT if do == "open" else LARGEST_ORDER for do in ORDERS}
MOST_TABS = 16

GOING_AWAY = 1001
POLICY_VIOLATION = 1008
TRY_AGAIN_LATER = 1013


class Hub:
    """All tabs, and the simulation that they look at. Everything but `hear` is the event loop's."""

    def __init__(self, runner: Running):
        self.runner = runner
        self.tabs: list[Tab] = []  # the one that is here for longest first
        self.driver: Tab | None = None
        self._heard = Outbox()
        self._lock = threading.Lock()
        self._loop: asyncio.AbstractEventLoop | None = None
        self._stop_listening: Callable[[], None] = _nothing

    def hear(self, telling: Telling) -> None:
        """Take what the simulation tells, in its own thread."""
        with self._lock:
            if self._loop is None:
                return
            first = len(self._heard) == 0
            self._heard.put(telling)
            if first:
                with suppress(RuntimeError):  # the loop has ended
                    self._loop.call_soon_threadsafe(self._pass_on)

    def _pass_on(self) -> None:
        with self._lock:
            heard, self._heard = self._heard, Outbox()
        while (telling := heard.take()) is not None:
            for tab in self.tabs:
                tab.put(self._for(tab, telling))

    def _for(self, tab: Tab, telling: Telling) -> Telling:
        """Return what is told to a tab: a welcome says whether it drives."""
        if telling.kind == "text" and telling.content.get("is") == "welcome":
            content = {**telling.content, "drives": tab is self.driver}
            return telling._replace(content=content)
        return telling

    async def serve(self, websocket: WebSocket) -> None:
        """Stay with a page from the moment it connects until it leaves."""
        with suppress(WebSocketDisconnect):
            await self._stay(websocket)

    async def _stay(self, websocket: WebSocket) -> None:
        await websocket.accept()
        if len(self.tabs) >= MOST_TABS:
            await websocket.close(TRY_AGAIN_LATER, f"{MOST_TABS} tabs are open; close one")
            return
        tab = Tab()
        self._enter(tab)
        try:
            # Whatever is told while the greeting is put together waits behind it.
            for message in await to_thread.run_sync(self.runner.greeting):
                telling = self._for(tab, Telling("text", message))
                await _send(websocket, as_json(telling.content))
            async with create_task_group() as group:

                async def both_ways(work: Callable[[WebSocket, Tab], Awaitable[None]]) -> None:
                    with suppress(WebSocketDisconnect):
                        await work(websocket, tab)
                    group.cancel_scope.cancel()

                group.start_soon(both_ways, self._write)
                group.start_soon(both_ways, self._read)
        finally:
            self._leave(tab)

    def _enter(self, tab: Tab) -> None:
        if not self.tabs:
            loop = asyncio.get_running_loop()
            with self._lock:
                self._loop, self._heard = loop, Outbox()
            self._stop_listening = self.runner.listen(self.hear)
        self.tabs.append(tab)
        # While time stands no other comes; it waits behind the greeting.
        newest = self.runner.newest()
        if newest is not None:
            tab.put(Telling("frame", newest))
        if self.driver is None:
            self.driver = tab

    def _leave(self, tab: Tab) -> None:
        self.tabs.remove(tab)
        if self.driver is tab:
            self._drive(self.tabs[0] if self.tabs else None)
        if not self.tabs:
            self._stop_listening()
            with self._lock:
                self._loop = None
        self._watch()

    def _drive(self, tab: Tab | None) -> None:
        before, self.driver = self.driver, tab
        if before is tab:
            return
        for other, drives in ((before, False), (tab, True)):
            if other is not None:
                other.tell({"is": "role", "drives": drives})

    def _watch(self) -> None:
        self.runner.watched(frozenset().union(*(tab.sees for tab in self.tabs)))

    async def _write(self, websocket: WebSocket, tab: Tab) -> None:
        """Send what waits, until the connection is to be closed or is lost."""
        while (content := await tab.next()) is not None:
            await _send(websocket, content)
        with _gone_if_closed():
            await websocket.close(*tab.closing)

    async def _read(self, websocket: WebSocket, tab: Tab) -> None:
        """Take what the page sends, until it leaves or sends too much."""
        while True:
            event = await websocket.receive()
            if event["type"] == "websocket.disconnect":
                return
            if tab.is_closing:
                continue
            now = time.monotonic()
            if not tab.rate.allows(now):
                why = "a page may send 200 messages a second; the connection is closed"
                tab.tell({"is": "refused", "why": why})
                tab.close(POLICY_VIOLATION, why)
                continue
            try:
                if event.get("text") is None:
                    raise RefusalError("a page sends text, and this is binary")
                order = parse_order(event["text"], SIZES)
            except RefusalError as refusal:
                tab.tell({"is": "refused", "why": str(refusal)})
                if tab.faults.too_many(now):
                    tab.close(POLICY_VIOLATION, "too many messages that cannot be understood")
                continue
            self._take(tab, order)

    def _take(self, tab: Tab, order: dict[str, Any]) -> None:
        """Do an order, or hand it to the simulation."""
        try:
            judge_order(order)
            match order["do"]:
                case "ack":
                    tab.acknowledge(order["frame"])
                case "see":
                    tab.see(frozenset(order["overlays"]))
                    self._watch()
                case "drive":
                    self._drive(tab)
                case _:
                    self._hand_over(tab, order)
                    return
        except PolypodError as refusal:
            _answer(tab, order, str(refusal))
        else:
            _answer(tab, order, None)

    def _hand_over(self, tab: Tab, order: dict[str, Any]) -> None:
        if tab is not self.driver and order["do"] not in FOR_ALL:
            raise RefusalError("another tab drives; take over to change things")
        if tab.orders >= MOST_ORDERS:
            raise RefusalError("the studio is busy; try again in a moment")
        loop = asyncio.get_running_loop()
        tab.orders += 1

        def answered(why: str | None) -> None:
            tab.orders -= 1
            _answer(tab, order, why)

        def answer(why: str | None) -> None:
            # The simulation may answer after the loop has ended.
            with suppress(RuntimeError):
                loop.call_soon_threadsafe(answered, why)

        self.runner.order({key: order[key] for key in order if key != "id"}, answer)


@contextmanager
def _gone_if_closed() -> Iterator[None]:
    """Take a connection that the server has closed already as one that is lost.

    When the studio ends, or a page does not answer, uvicorn closes connections of itself; who sends
    before hearing of it gets a RuntimeError, not a WebSocketDisconnect.
    """
    try:
        yield
    except RuntimeError as closed:
        raise WebSocketDisconnect(GOING_AWAY) from closed


async def _send(websocket: WebSocket, content: str | bytes) -> None:
    with _gone_if_closed():
        if isinstance(content, str):
            await websocket.send_text(content)
        else:
            await websocket.send_bytes(content)


def _nothing() -> None:
    """Stop listening where nobody listens."""


def _answer(tab: Tab, order: dict[str, Any], why: str | None) -> None:
    """Tell a tab that its order was done or why it was not; without an id only the latter."""
    said: dict[str, Any] = {"is": "done"} if why is None else {"is": "refused", "why": why}
    if "id" in order:
        tab.tell(said | {"id": order["id"]})
    elif why is not None:
        tab.tell(said)
