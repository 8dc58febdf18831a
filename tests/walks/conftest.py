"""The acceptance walks' own creatures, places and audit, for the slice of them that is tested."""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
