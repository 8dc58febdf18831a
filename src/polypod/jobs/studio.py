"""`polypod studio`: a page where a creature walks and everything can be changed while it does."""

from __future__ import annotations

import argparse
from importlib.util import find_spec

from polypod.errors import SettingError
from polypod.jobs.rig_options import DEFAULT_RIG, RIG_HELP, add_rig_options
from polypod.jobs.values import filled, whole

DESCRIPTION = """Opens a page where a creature walks and everything can be changed while it does.

  polypod studio
  polypod studio fox.glb --height 0.8
  polypod studio crates.toml"""
NEEDED = ("nicegui", "starlette", "uvicorn", "websockets")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options of `polypod studio`."""
    parser.add_argument(
        "rig",
        nargs="?",
        type=filled,
        metavar="RIG|SCENE",
        help=f"{RIG_HELP}; or a scene file; omitted: {DEFAULT_RIG}",
    )
    add_rig_options(parser)
    parser.add_argument(
        "--scene", type=filled, metavar="SCENE.toml", help="where to walk; omitted: flat ground"
    )
    parser.add_argument(
        "--port",
        type=whole(0, 65535, "a port"),
        metavar="N",
        help="of this computer; 0: any that is free; omitted: 8571, or any where that is taken",
    )
    parser.add_argument(
        "--no-browser", action="store_true", help="only print the address, open no browser"
    )


def run(given: argparse.Namespace) -> int:
    """Open what is asked for and serve it until Ctrl-C."""
    if any(find_spec(name) is None for name in NEEDED):
        raise SettingError('the studio needs more than is installed: pip install "polypod[studio]"')
    from polypod.studio.opening import open_studio

    open_studio(given)
    return 0
