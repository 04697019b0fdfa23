"""A study: the settings its collisions share, and in what they differ."""

from pathlib import Path
from typing import Annotated, Any

from pydantic import ConfigDict, Field

from campaigns.dotted_keys import flatten, nest
from campaigns.members import ErrorBars
from engine.errors import SceneError
from engine.scene.collision import Collision
from engine.scene.fields import Frozen, key, read_table, validate
from engine.scene.input_errors import KeysOfModel, did_you_mean

Name = Annotated[str, Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9._-]*$", max_length=100)]

SHIPPED = Path(__file__).parent / "studies"


class Case(Frozen):
    """One line of a study that is no grid: settings of the collision, and what to call it."""

    model_config = ConfigDict(extra="allow")

    name: Annotated[Name | None, key("label in the results, instead of the settings in short")] = None

    @property
    def settings(self) -> dict[str, Any]:
        """Dotted keys of the collision and their values."""
        return flatten(self.model_extra or {})


class Study(Frozen):
    """Content of a study file.

    Every combination of the values of `axes` is a job. With `cases` as well, every case is run for every combination,
    or, where it sets a key of the axes itself, at that value only.
    """

    name: Annotated[Name, key("name of the study and of its results directory")]
    description: Annotated[str, key("what the study is for")] = ""
    collision: Annotated[
        dict[str, Any], KeysOfModel(Collision), Field(default_factory=dict), key("settings of all its collisions")
    ]
    axes: Annotated[dict[str, Any] | None, key("values of dotted keys of the collision")] = None
    cases: Annotated[list[Case] | None, key("settings of each collision where they are no grid")] = None
    error_bars: Annotated[ErrorBars | None, key("two resolutions and several seeds of each collision")] = None

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
    raise SceneError(f"no study '{name}': neither a file nor a shipped study{did_you_mean(name, names, 'studies')}")


def read_study(path: Path) -> Study:
    """The study in a TOML file.

    Raises:
        SceneError: the file cannot be read or its content is not a study.
    """
    return validate(Study, read_table(path), str(path))
