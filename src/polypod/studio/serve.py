"""Serves the studio on this computer: 127.0.0.1 and no other interface."""

from __future__ import annotations

import logging
import secrets
import socket
import threading
import webbrowser
from collections.abc import Callable

import uvicorn

from polypod.errors import SettingError
from polypod.studio.app import make_app
from polypod.studio.guard import LARGEST_DOCUMENT
from polypod.studio.rigs_given import GivenRigs
from polypod.studio.seam import Running
from polypod.studio.world_files import WorldFiles

HOME = "127.0.0.1"
USUAL_PORT = 8571  # the same each time, so that links to a state go on leading somewhere
PING_EVERY = 10.0  # s; a page that does not answer for as long is gone


class Answered(logging.Filter):
    """Leaves out a complaint of uvicorn's that is none: a websocket was refused with an answer."""

    def filter(self, record: logging.LogRecord) -> bool:
        """Return whether a record is logged."""
        return "without completing handshake" not in record.getMessage()


def bind(port: int | None) -> socket.socket:
    """Return a socket that listens on a port of this computer.

    Args:
        port: 0: any that is free; None: the usual one, or any where that is taken.

    Raises:
        SettingError: the port is taken, or not for users.
    """
    listener = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        try:
            listener.bind((HOME, USUAL_PORT if port is None else port))
        except OSError:
            if port is not None:
                raise
            listener.bind((HOME, 0))
        # From here on a browser that comes early waits.
        listener.listen(64)
    except OSError as error:
        listener.close()
        raise SettingError(
            f"--port {port}: cannot be used ({error.strerror}); give another, or 0 for a free one"
        ) from None
    return listener


def serve(
    runner: Running,
    rigs: GivenRigs,
    files: WorldFiles,
    listener: socket.socket,
    opened: Callable[[str], None],
) -> None:
    """Serve until Ctrl-C or a signal to end.

    Args:
        runner: the simulation, started.
        rigs: that were given; their folder is deleted at the end.
        files: of the world, likewise.
        listener: from `bind`.
        opened: called with the address before anything is served.
    """
    port = int(listener.getsockname()[1])
    config = uvicorn.Config(
        make_app(runner, rigs, files, secrets.token_urlsafe(32), port),
        log_level="warning",
        access_log=False,
        lifespan="off",
        ws="websockets-sansio",
        ws_max_size=LARGEST_DOCUMENT,
        ws_ping_interval=PING_EVERY,
        ws_ping_timeout=PING_EVERY,
        ws_per_message_deflate=False,
        proxy_headers=False,
        server_header=False,
        timeout_graceful_shutdown=2,
    )
    logging.getLogger("uvicorn.error").addFilter(Answered())
    opened(f"http://{HOME}:{port}/")
    try:
        uvicorn.Server(config).run(sockets=[listener])
    except KeyboardInterrupt:
        # uvicorn has ended in order and hands Ctrl-C on.
        return
    finally:
        listener.close()


def open_browser(address: str) -> None:
    """Open a browser, if this computer has one, without waiting for it."""
    threading.Thread(target=webbrowser.open, args=(address,), daemon=True).start()
