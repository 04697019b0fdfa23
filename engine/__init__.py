"""One simulation: a scene in, a job directory out."""

from importlib import import_module
from typing import TYPE_CHECKING

PHYSICS_VERSION = 7
"""Raised by hand whenever the same scene gives other results."""

__all__ = ["PHYSICS_VERSION", "Collision", "Scene", "open_scene"]

if TYPE_CHECKING:
    from engine.api import open_scene
    from engine.scene.collision import Collision
    from engine.scene.scene import Scene
else:
    _HOMES = {"Collision": "engine.scene.collision", "Scene": "engine.scene.scene", "open_scene": "engine.api"}

    def __getattr__(name):
        """Import a public name when it is first used."""
        if name not in _HOMES:
            raise AttributeError(f"module 'engine' has no attribute '{name}'")
        return getattr(import_module(_HOMES[name]), name)
