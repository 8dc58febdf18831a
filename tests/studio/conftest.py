"""A served studio for each test."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from studio.server import Served, served


@pytest.fixture
def studio() -> Iterator[Served]:
    with served() as made:
        yield made
