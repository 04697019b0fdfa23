"""Shared by all tests."""

from collections.abc import Iterator

import pytest


@pytest.fixture
def taichi() -> Iterator[None]:
    """A freshly started Taichi on one thread; fields of earlier tests are gone."""
    from engine import backend

    backend.start(threads=1)
    yield
