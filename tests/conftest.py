"""Shared by all tests."""

import os
from collections.abc import Iterator

import pytest
from hypothesis import settings

# a check of a speed is no test
settings.register_profile("untimed", deadline=None)
settings.load_profile("untimed")


@pytest.fixture
def taichi() -> Iterator[None]:
    """A freshly started Taichi, on one thread or the device that TEST_ARCH names; fields of earlier tests are gone."""
    from engine.device import backend

    arch = os.environ.get("TEST_ARCH", "cpu")
    backend.start(arch, threads=1)
    assert backend.on_gpu() == (arch != "cpu")
    yield
