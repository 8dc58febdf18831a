"""`polypod studio`, as a user starts it, and its server, as the network reaches it."""

from __future__ import annotations

import http.client
import json
import re
import signal
import socket
import subprocess
import sys
from collections.abc import Iterator
from typing import Any

import pytest
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import connect

from cli.running import assert_refused, polypod
from polypod.jobs import studio as job
from polypod.studio import serve


class Process:
    """A studio in a process of its own."""

    def __init__(self, *words: str) -> None:
        command = [sys.executable, "-m", "polypod", "studio", "--no-browser", "--port", "0", *words]
        self.child = subprocess.Popen(
            command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
        )
        assert self.child.stdout is not None
        said = self.child.stdout.readline()
        found = re.search(r"http://127\.0\.0\.1:(\d+)/", said)
        assert found, (said, self.child.poll())
        self.port = int(found[1])
        page = self.raw(b"GET / HTTP/1.1\r\nHost: %s\r\nConnection: close\r\n\r\n" % self.host)
        self.token = re.search(rb'polypod-token" content="([^"]+)"', page)[1].decode()  # type: ignore[index]

    @property
    def host(self) -> bytes:
        return f"127.0.0.1:{self.port}".encode()

    def raw(self, request: bytes) -> bytes:
        """Send bytes and return all that comes back."""
        with socket.create_connection(("127.0.0.1", self.port), timeout=30) as line:
            line.sendall(request)
            pieces = []
            while piece := line.recv(65536):
                pieces.append(piece)
        return b"".join(pieces)

    def link(self) -> Any:
        home = f"127.0.0.1:{self.port}"
        return connect(f"ws://{home}/link?token={self.token}", origin=f"http://{home}")  # type: ignore[arg-type]

    def end(self, number: int) -> tuple[int, str]:
        """Send a signal; return the exit code and what was said on stderr."""
        self.child.send_signal(number)
        _, said = self.child.communicate(timeout=60)
        return self.child.returncode, said


@pytest.fixture(scope="module")
def running() -> Iterator[Process]:
    """Start a studio; that it ends in order is part of every test here."""
    made = Process("wolf")
    yield made
    with made.link():
        code, said = made.end(signal.SIGINT)
    assert (code, "Traceback" in said) == (0, False), said
    assert said.endswith("the studio is closed\n")
    assert "ASGI" not in said, "what was refused is no fault of ours"


def test_only_this_computer_is_listened_to(running: Process) -> None:
    with open("/proc/net/tcp") as table:
        listening = [line.split() for line in table if line.split()[3] == "0A"]
    port = f"{running.port:04X}"
    assert [one[1] for one in listening if one[1].endswith(f":{port}")] == [f"0100007F:{port}"]


@pytest.mark.parametrize(
    "path",
    [
        b"/page/../app.py", b"/page/../../../../etc/passwd", b"/page/%2e%2e/app.py",
        b"/page/..%2fapp.py", b"/page/%2e%2e%2fapp.py", b"/page//etc/passwd",
        b"/page/%2fetc%2fpasswd", b"/page/....//app.py", b"/page/..\\app.py", b"/page/%00",
        b"/page/main.js%00.css", b"/page/index.html", b"/page/", b"/vendor/../app.py",
    ],
)  # fmt: skip
def test_no_path_leads_out_of_the_page(running: Process, path: bytes) -> None:
    request = b"GET %s HTTP/1.1\r\nHost: %s\r\nConnection: close\r\n\r\n" % (path, running.host)
    answer = running.raw(request)
    assert answer.startswith(b"HTTP/1.1 404"), answer[:200]
    assert b"root:" not in answer
    assert b"import" not in answer


def test_a_gigabyte_is_refused_by_its_length_alone(running: Process) -> None:
    request = http.client.HTTPConnection("127.0.0.1", running.port, timeout=30)
    request.putrequest("POST", "/rig")
    request.putheader("Origin", f"http://127.0.0.1:{running.port}")
    request.putheader("X-Polypod-Token", running.token)
    request.putheader("Content-Length", str(1 << 30))
    request.endheaders()
    answer = request.getresponse()
    assert answer.status == 413
    assert b"64 MiB" in answer.read()
    request.close()


def test_malformed_requests_are_refused(running: Process) -> None:
    for request in (
        b"\x16\x03\x01\x02\x00\x01\x00\r\n\r\n",
        b"GET / HTTP/9.9\r\n\r\n",
        b"\r\n" * 9,
        b"GET / HTTP/1.1\r\nHost: evil.example\r\nConnection: close\r\n\r\n",
    ):
        with socket.create_connection(("127.0.0.1", running.port), timeout=10) as line:
            line.sendall(request)
            line.shutdown(socket.SHUT_WR)
            answer = line.recv(4096)
        assert not answer.startswith(b"HTTP/1.1 200")


def test_a_page_from_elsewhere_is_told_why_it_gets_no_link(running: Process) -> None:
    home = f"127.0.0.1:{running.port}"
    with pytest.raises(InvalidStatus) as refused:
        connect(f"ws://{home}/link?token={running.token}", origin="http://evil.example")  # type: ignore[arg-type]
    assert refused.value.response.status_code == 403
    assert b"only the studio's own page" in refused.value.response.body


def test_a_tab_is_greeted_drives_and_gets_frames(running: Process) -> None:
    with running.link() as tab:
        said: dict[str, Any] = {}
        frames = 0
        while frames < 3:
            message = tab.recv(timeout=30)
            if isinstance(message, bytes):
                frames += 1
            else:
                found = json.loads(message)
                said.setdefault(found["is"], found)
        assert said["welcome"]["drives"] is True
        assert said["document"]["document"]["creature"]["rig"] == "wolf"
        assert {"creature", "kinds", "clock", "verdict", "tape"} <= set(said)
        tab.send('{"do": "edit", "at": ["command", "speed"], "to": NaN, "id": 1}')
        tab.send('{"do": "edit", "at": ["command", "speed"], "to": 1.25, "id": 2}')
        answers = []
        while len(answers) < 2:
            message = tab.recv(timeout=30)
            if isinstance(message, str) and json.loads(message)["is"] in ("done", "refused"):
                answers.append(json.loads(message))
        assert "NaN" in answers[0]["why"]
        assert answers[1] == {"is": "done", "id": 2}


@pytest.mark.parametrize("content", [b"\xff" * 100, "x" * (2 << 20)], ids=["binary", "2 MiB"])
def test_what_the_page_never_sends(running: Process, content: bytes | str) -> None:
    with running.link() as tab:
        refused = False
        try:
            tab.send(content)
            for _ in range(100):
                message = tab.recv(timeout=30)
                refused = refused or (isinstance(message, str) and '"refused"' in message)
                if refused:
                    break
        except ConnectionClosed as closed:
            # The reason may be lost where the line is cut while more is under way.
            refused = closed.rcvd is None or closed.rcvd.code == 1009
        assert refused
    with running.link() as tab:
        assert tab.recv(timeout=30), "it goes on"


def test_without_the_extra_it_says_what_to_install(monkeypatch: Any) -> None:
    monkeypatch.setattr(job, "NEEDED", ("starlette", "a_package_that_nobody_has"))
    assert_refused(polypod("studio"), 'pip install "polypod[studio]"')


def test_the_command_line_needs_none_of_the_extra() -> None:
    code = (
        "import sys; from polypod.cli import make_parser; make_parser();"
        "print([n for n in ('numpy', 'starlette', 'uvicorn', 'nicegui') if n in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.stdout == "[]\n", done.stderr


@pytest.mark.parametrize(
    ("words", "parts"),
    [
        (["nosuch"], ["nosuch", "spider"]),
        (["nosuch.glb"], ["nosuch.glb"]),
        (["x" * 5000 + ".glb"], [".glb"]),
        (["--port", "70000"], ["--port", "65535"]),
        (["--port", "-1"], ["--port"]),
        (["--port", "http"], ["--port"]),
        (["--scene", "nosuch.toml"], ["nosuch.toml"]),
        (["--forward", "up"], ["--forward"]),
        (["--height", "nan"], ["--height"]),
        (["wolf", "spider"], ["spider"]),
        (["--speed", "1"], ["--speed"]),
    ],
    ids=lambda value: " ".join(value)[:40],
)
def test_what_cannot_be_opened_is_said(words: list[str], parts: list[str]) -> None:
    assert_refused(polypod("studio", "--no-browser", *words), *parts)


def test_a_port_that_is_taken_is_said_and_the_usual_one_is_given_up(monkeypatch: Any) -> None:
    with serve.bind(0) as taken:
        port = taken.getsockname()[1]
        assert_refused(polypod("studio", "--no-browser", "--port", str(port)), str(port))
        monkeypatch.setattr(serve, "USUAL_PORT", port)
        with serve.bind(None) as other:
            assert other.getsockname()[1] not in (0, port)
            assert other.getsockname()[0] == "127.0.0.1"
