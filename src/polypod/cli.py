"""The command `polypod`: what a user types, judged, and handed to a job.

Nothing heavy is imported before a job runs, so `--help` is instant. A fault of the user's is one
sentence and exit code 2; Ctrl-C is 130; a fault of ours is one sentence and exit code 1, with the
traceback where POLYPOD_DEBUG=1 asks for it.
"""

from __future__ import annotations

import argparse
import os
import signal
import sys
from collections.abc import Sequence
from importlib import import_module
from typing import Any, NoReturn

from polypod import __version__
from polypod.errors import PolypodError

BAD_INPUT = 2
BUG = 1
INTERRUPTED = 130
TERMINATED = 143
# Each is a module of polypod.jobs with `add_arguments` and `run`, or `run_bench`.
JOBS = {
    "walk": "make a creature walk",
    "rig": "say what was found in a rig",
    "gait": "list gaits, or show one",
    "studio": "design a walk with your hands, on a page",
    "bench": "measure this machine, beside the paper's own figures",
    "warmup": "compile everything now",
}


class Parser(argparse.ArgumentParser):
    """A parser whose errors are one sentence, without the usage in front."""

    def error(self, message: str) -> NoReturn:
        """Print the sentence and exit with code 2."""
        if message.startswith("argument "):
            message = message.removeprefix("argument ")
        self.exit(BAD_INPUT, f"polypod: {one_line(message)} ({self.prog} --help says more)\n")


def one_line(text: object) -> str:
    """Return a text as a single line without control characters."""
    line = " ".join(str(text).split())
    return "".join(c if c.isprintable() else repr(c)[1:-1] for c in line)


def make_parser() -> Parser:
    """Return the parser of the whole command line."""
    parser = Parser(
        prog="polypod",
        description="Makes any legged creature walk.",
        allow_abbrev=False,
    )
    parser.add_argument("--version", action="version", version=f"polypod {__version__}")
    commands = parser.add_subparsers(dest="command", metavar="COMMAND", required=True)
    for name, summary in JOBS.items():
        job = import_module(f"polypod.jobs.{name}")
        command = commands.add_parser(
            name,
            help=summary,
            description=getattr(job, "DESCRIPTION", summary),
            formatter_class=argparse.RawDescriptionHelpFormatter,
            allow_abbrev=False,
        )
        job.add_arguments(command)
        command.set_defaults(run=job.run_bench if name == "bench" else job.run)
    return parser


def glue_values(parser: Parser, words: Sequence[str]) -> list[str]:
    """Return the words with values that start with - tied to their options.

    Without it `--forward -x` and `--path -1,0` would read as options.
    """
    options: dict[str, bool] = {}
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction) and words and words[0] in action.choices:
            chosen = action.choices[words[0]]
            options = {o: a.nargs != 0 for a in chosen._actions for o in a.option_strings}
    glued: list[str] = []
    waiting = list(words)
    while waiting:
        word = waiting.pop(0)
        if word == "--":
            return [*glued, word, *waiting]
        next_word = waiting[0] if waiting else ""
        if options.get(word) and next_word.startswith("-") and next_word not in options:
            word = f"{word}={waiting.pop(0)}"
        glued.append(word)
    return glued


def main(words: Sequence[str] | None = None) -> int:
    """Run the command line and return its exit code."""
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="backslashreplace")
    if hasattr(signal, "SIGTERM"):
        _exit_on_terminate()
    try:
        parser = make_parser()
        given = parser.parse_args(glue_values(parser, sys.argv[1:] if words is None else words))
        code = int(given.run(given))
        sys.stdout.flush()
        return code
    except SystemExit as end:
        return end.code if isinstance(end.code, int) else BUG
    except BaseException as error:
        return _explain(error)


def _exit_on_terminate() -> None:
    """Let a terminated run clean up as an interrupted one does."""

    def leave(number: int, frame: Any) -> None:
        raise SystemExit(TERMINATED)

    try:
        signal.signal(signal.SIGTERM, leave)
    except ValueError:
        # Not in the main thread: whoever runs us there has handlers of their own.
        return


def _explain(error: BaseException) -> int:
    """Print what went wrong as one sentence and return the exit code."""
    if os.environ.get("POLYPOD_DEBUG", "") not in ("", "0"):
        import traceback

        traceback.print_exception(error)
    if isinstance(error, KeyboardInterrupt):
        _say("interrupted; no file was left half written")
        return INTERRUPTED
    if isinstance(error, BrokenPipeError):
        # Whoever read our output has left, as `head` does; nothing more can be said to them.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    if isinstance(error, PolypodError):
        _say(error)
        return BAD_INPUT
    if isinstance(error, MemoryError):
        _say("there is not enough memory for this; ask for fewer creatures, frames or obstacles")
        return BAD_INPUT
    if isinstance(error, OSError):
        where = f"{error.filename}: " if error.filename else ""
        _say(f"{where}{error.strerror or error}")
        return BAD_INPUT
    _say(
        f"this is a fault of Polypod's own, please report it with what you typed: "
        f"{type(error).__name__}: {error} (POLYPOD_DEBUG=1 shows where it happened)"
    )
    return BUG


def _say(message: object) -> None:
    print(f"polypod: {one_line(message)}", file=sys.stderr)
