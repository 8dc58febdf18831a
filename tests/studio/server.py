"""A studio with a simulation that only listens and tells, for tests of what is around it."""

from __future__ import annotations

import struct
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import Future
from contextlib import contextmanager
from types import SimpleNamespace
from typing import Any

from starlette.testclient import TestClient

from polypod.errors import PolypodError
from polypod.studio.app import make_app
from polypod.studio.document import default_document
from polypod.studio.messages import files_message
from polypod.studio.outbox import Telling
from polypod.studio.rigs_given import GivenRigs
from polypod.studio.world_files import WorldFiles

PORT = 8571
TOKEN = "the-token"
HOME = f"http://127.0.0.1:{PORT}"
OURS = {"Origin": HOME, "X-Polypod-Token": TOKEN}


class FakeRunner:
    """Keeps orders, answers at once, and tells what a test has it tell."""

    def __init__(self) -> None:
        self.orders: list[dict[str, Any]] = []
        self.listeners: list[Callable[[Any], None]] = []
        self.seen: list[frozenset[str]] = []
        self.said: list[dict[str, Any]] = []
        self.refuses: str | None = None
        self.silent = False
        self.last: bytes | None = None
        stage = SimpleNamespace(document=default_document())
        self.conductor = SimpleNamespace(
            stage=stage, tape=None, take=self._take, tell_files=self._tell_files
        )

    def _tell_files(self) -> None:
        self.said.append(files_message(self.conductor))

    def start(self) -> None: ...

    def stop(self) -> None: ...

    def order(self, order: dict[str, Any], answer: Callable[[str | None], None]) -> None:
        self.orders.append(order)
        if not self.silent:
            threading.Thread(target=answer, args=(self.refuses,)).start()

    def call(self, work: Callable[[Any], Any]) -> Future[Any]:
        future: Future[Any] = Future()
        try:
            future.set_result(work(self.conductor))
        except PolypodError as error:
            future.set_exception(error)
        return future

    def listen(self, hear: Callable[[Any], None]) -> Callable[[], None]:
        self.listeners.append(hear)
        return lambda: self.listeners.remove(hear)

    def greeting(self) -> list[dict[str, Any]]:
        return [{"is": "welcome", "fps": 60}, {"is": "clock", "time": 0.0}]

    def newest(self) -> bytes | None:
        return self.last

    def skin(self, number: int) -> bytes | None:
        return b"skin" if number == 3 else None

    def ground(self, number: int) -> bytes | None:
        return b"ground" if number == 4 else None

    def watched(self, overlays: frozenset[str]) -> None:
        self.seen.append(overlays)

    def tell(self, kind: str, content: Any, name: str = "") -> None:
        for hear in list(self.listeners):
            hear(Telling(kind, content, name))

    def frame(self, number: int) -> None:
        self.tell("frame", struct.pack("<II", 1, number))

    def _take(self, document: dict[str, Any]) -> None:
        self.conductor.stage.document = document


class Served:
    """A studio and a client of it that is the studio's own page."""

    def __init__(self) -> None:
        self.runner = FakeRunner()
        self.rigs = GivenRigs()
        self.files = WorldFiles()
        self.runner.conductor.stage.files = self.files
        self.app = make_app(self.runner, self.rigs, self.files, TOKEN, PORT)
        self.client = TestClient(self.app, base_url=HOME)

    @contextmanager
    def tab(self) -> Iterator[Any]:
        """Open a tab and take its greeting; `drives` says whether it drives."""
        headers = {"Origin": HOME, "Host": f"127.0.0.1:{PORT}"}
        with self.client.websocket_connect(f"/link?token={TOKEN}", headers=headers) as socket:
            welcome = socket.receive_json()
            assert welcome["is"] == "welcome"
            assert socket.receive_json()["is"] == "clock"
            socket.drives = welcome["drives"]
            yield socket


@contextmanager
def served() -> Iterator[Served]:
    """Serve a studio; its uploads are deleted at the end."""
    studio = Served()
    try:
        with studio.client:
            yield studio
    finally:
        studio.rigs.close()
        studio.files.close()
