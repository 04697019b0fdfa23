"""A study: the settings its collisions share, and in what they differ."""

from pathlib import Path
from typing import Annotated, Any

from pydantic import ConfigDict, Field

from campaigns.dotted_keys import flatten, nest
from campaigns.members import ErrorBars
from engine.errors import SceneError
from engine.scene.collision import Collision
from engine.scene.fields import Frozen, read_table, validate
from engine.scene.input_errors import KeysOf, suggestion

Name = Annotated[str, Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9._-]*$", max_length=100)]

SHIPPED = Path(__file__).parent / "studies"


class Case(Frozen):
    """One line of a study that is no grid: settings of the collision, and what to call it.

    name: label in the results, instead of the settings in short.
    """

    model_config = ConfigDict(extra="allow")

    name: Name | None = None

    @property
    def settings(self) -> dict[str, Any]:
        """Dotted keys of the collision and their values."""
        return flatten(self.model_extra or {})


class Study(Frozen):
    """What a study file holds.

    name: name of the study and of its results directory.
    collision: settings of all collisions, keys as in engine.scene.collision.Collision.
    axes: dotted key of the collision -> its values; every combination is a job.
    cases: one table of settings for each collision, where they are no grid; together with axes, every case is run for
        every combination of the axes, or, where it sets a key of theirs itself, at that value only.
    error_bars: run each of these collisions at two resolutions and with several seeds.
    """

    name: Name
    description: str = ""
    collision: Annotated[dict[str, Any], KeysOf(Collision), Field(default_factory=dict)]
    axes: dict[str, Any] | None = None
    cases: list[Case] | None = None
    error_bars: ErrorBars | None = None

    def collision_with(self, changes: dict[str, Any], source: str) -> Collision:
        """The collision of one job.

        Args:
            changes: dotted keys and values that replace those of the study.
            source: the origin that errors name.

        Raises:
            SceneError: the settings are no collision.
        """
        return validate(Collision, nest(flatten(self.collision) | changes), source)

    def shared_settings(self, source: str) -> dict[str, Any]:
        """The settings of all jobs by dotted key, defaults included; velocity 1 and angle 0 where none is shared.

        Raises:
            SceneError: the settings are no collision.
        """
        required = {"velocity": 1.0, "angle": 0.0}
        shared = validate(Collision, nest(required | flatten(self.collision)), source)
        return flatten(shared.model_dump(mode="json"))


def find_study(name: str) -> Path:
    """The file of a study given by its shipped name or by a path.

    Raises:
        SceneError: there is no such study.
    """
    names = sorted(path.stem for path in SHIPPED.glob("*.toml"))
    if name in names:
        return SHIPPED / f"{name}.toml"
    if Path(name).exists():
        return Path(name)
    raise SceneError(f"no study '{name}': neither a file nor a shipped study{suggestion(name, names, 'studies')}")


def read_study(path: Path) -> Study:
    """The study in a TOML file.

    Raises:
        SceneError: the file cannot be read or its content is not a study.
    """
    return validate(Study, read_table(path), str(path))
