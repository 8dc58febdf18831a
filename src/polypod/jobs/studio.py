"""`polypod studio`: a page where a creature walks and everything can be changed while it does."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from polypod.studio.opening import open_studio

    open_studio(given)
    return 0
