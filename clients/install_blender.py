"""Makes an environment of its own in clients/.bpy with Blender as a Python package.

Usage: python clients/install_blender.py

Each version of bpy fits one version of Python exactly, which need not be the one Polypod runs on.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

ENVIRONMENT = Path(__file__).parent / ".bpy"
PYTHON, REQUIREMENT = "3.11", "bpy>=4.5,<4.6"


def main() -> int:
    """Return 0 once Blender can be imported there."""
    here = f"{sys.version_info.major}.{sys.version_info.minor}" == PYTHON
    python = sys.executable if here else shutil.which(f"python{PYTHON}")
    if python is None:
        print(f"Blender needs Python {PYTHON}, which is not on the path", file=sys.stderr)
        return 1
    subprocess.run([python, "-m", "venv", str(ENVIRONMENT)], check=True)
    inside = str(ENVIRONMENT / ("Scripts" if sys.platform == "win32" else "bin") / "python")
    subprocess.run([inside, "-m", "pip", "install", "--quiet", REQUIREMENT], check=True)
    return subprocess.run([inside, "-c", "import bpy"]).returncode


if __name__ == "__main__":
    sys.exit(main())
