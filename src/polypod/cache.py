"""Where compiled kernels are kept. Imports nothing heavy: it runs before Numba is imported."""

from __future__ import annotations

import hashlib
import os
import sys
from functools import cache
from pathlib import Path

PACKAGE_FOLDER = Path(__file__).parent
# Rooms without a kernel: who works on the page need not compile anew.
WITHOUT_KERNELS = ("studio",)


def user_cache_folder() -> Path:
    """Return the folder for compiled kernels, following each system's custom."""
    if "POLYPOD_CACHE" in os.environ:
        return Path(os.environ["POLYPOD_CACHE"])
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA", Path.home() / "AppData" / "Local")) / "polypod"
    if sys.platform == "darwin":
        return Path.home() / "Library" / "Caches" / "polypod"
    return Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache")) / "polypod"


@cache
def source_digest() -> str:
    """Return a digest of all the package's sources.

    Numba's cache does not notice an edited callee in another file and then gives wrong answers, so
    the cache folder is named after all the sources together, but for rooms that hold no kernels.
    """
    digest = hashlib.sha256()
    for path in sorted(PACKAGE_FOLDER.rglob("*.py")):
        if path.relative_to(PACKAGE_FOLDER).parts[0] in WITHOUT_KERNELS:
            continue
        digest.update(path.relative_to(PACKAGE_FOLDER).as_posix().encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


def kernel_cache_folder() -> Path:
    """Return the folder that holds the kernels compiled from the present sources."""
    return user_cache_folder() / "kernels" / source_digest()


def use_kernel_cache() -> None:
    """Point Numba at that folder; without effect once Numba has been imported."""
    os.environ.setdefault("NUMBA_CACHE_DIR", str(kernel_cache_folder()))
