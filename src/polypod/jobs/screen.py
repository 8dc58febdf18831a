"""What a run says while it works: progress, and what it is compiling. All of it on stderr."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from polypod.jobs import compile_rest

# Measured on two cores of 2020; said to the user as a rough figure.
COMPILE_SECONDS = 45
# Where stderr is no terminal, a line so often says how far a long job is.
LINE_EVERY_S = 10.0


def on_terminal() -> bool:
    """Return whether somebody watches stderr."""
    return sys.stderr.isatty()


def note(text: str) -> None:
    """Print a line for whoever waits."""
    print(text, file=sys.stderr, flush=True)


def warn(text: str) -> None:
    """Print a line worth knowing."""
    note(f"polypod: warning: {text}")


@contextmanager
def progress(title: str) -> Iterator[Callable[[int, int], None]]:
    """Give a function to call with (done, total); a bar on a terminal, else a line now and then."""
    bar: Any = None
    last_line = time.monotonic()

    def advance(done: int, total: int) -> None:
        nonlocal bar, last_line
        if on_terminal():
            if bar is None:
                from tqdm import tqdm

                bar = tqdm(total=total, desc=title, file=sys.stderr, leave=False)
            bar.update(done - bar.n)
        elif time.monotonic() - last_line > LINE_EVERY_S:
            last_line = time.monotonic()
            note(f"{title}: {done} of {total}")

    try:
        yield advance
    finally:
        if bar is not None:
            bar.close()


class CompileCounter:
    """Listens to Numba, and says that kernels are compiled from the moment one is."""

    def __init__(self, first_run: bool, whole: bool = True) -> None:
        self.count = 0
        self.depth = 0
        self.seconds = 0.0
        self.first_run = first_run
        self.whole = whole
        self.started = 0.0
        self.said = 0.0

    def start(self) -> None:
        """Count a function whose compilation starts, within another's or by itself."""
        if self.count == 0:
            self._begin()
        if self.depth == 0:
            self.started = time.monotonic()
        self.depth += 1
        self.count += 1
        self._tell()

    def end(self) -> None:
        """Add up the time of those that were by themselves."""
        self.depth -= 1
        if self.depth == 0:
            self.seconds += time.monotonic() - self.started

    def _begin(self) -> None:
        self.said = time.monotonic()
        about = "first run only" if self.first_run else "and keeping them for later runs"
        time_needed = f"about {COMPILE_SECONDS} s" if self.whole else "some seconds"
        note(f"compiling kernels ({about}, {time_needed})")

    def _tell(self) -> None:
        now = time.monotonic()
        seconds = self.seconds + now - self.started
        text = f"compiling kernels: {self.count} functions, {seconds:.0f} s"
        if on_terminal():
            print(f"\r{text} ", end="", file=sys.stderr, flush=True)
        elif now - self.said > LINE_EVERY_S:
            self.said = now
            note(text)

    def finish(self) -> None:
        """Say how long it took, if anything was compiled."""
        if self.count:
            text = f"compiled {self.count} functions in {self.seconds:.0f} s"
            # Spaces cover the rest of the line that counted.
            note(f"\r{text}{'':12}" if on_terminal() else text)


@contextmanager
def telling_of_compilation(whole: bool = True) -> Iterator[None]:
    """Say on screen what is compiled within, if anything is; `whole`: all that a walk needs."""
    folder = prepare_cache()
    from numba.core import event

    counter = CompileCounter(first_run=not any(folder.rglob("*.nbi")), whole=whole)
    events: Any = event

    class Listener(event.Listener):
        def on_start(self, event: Any) -> None:
            counter.start()

        def on_end(self, event: Any) -> None:
            counter.end()

    listener = Listener()
    events.register("numba:compile", listener)
    beside = compile_rest.start() if counter.first_run and whole else None
    try:
        yield
    finally:
        events.unregister("numba:compile", listener)
        if beside is not None:
            beside.kill()
            beside.wait()
        counter.finish()


def prepare_cache() -> Path:
    """Return the folder for compiled kernels, made writable; before any kernel is imported."""
    import tempfile

    from numba.core import config

    # Sets where Numba is to keep them, before Numba reads it.
    import polypod.compute  # noqa: F401

    settings: Any = config
    folder = Path(settings.CACHE_DIR)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            return folder
    except OSError as error:
        warn(
            f"kernels cannot be kept in {folder} ({error.strerror}), so each run compiles them "
            "anew; POLYPOD_CACHE names another folder"
        )
    settings.CACHE_DIR = tempfile.mkdtemp(prefix="polypod-kernels-")
    return Path(settings.CACHE_DIR)
