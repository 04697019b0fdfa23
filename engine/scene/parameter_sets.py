"""Published set-ups of one collision as tables laid under the keys of a study (engine/physics.md, sections 4-5)."""

from typing import Any

DEFAULT = "sugiura2018"
"""Set of a collision that names none."""

PARAMETER_SETS: dict[str, dict[str, Any]] = {
    "sugiura2018": {
        "materials": {"basalt": {"friction": 0.839}},  # tan 40 deg
        "fracture": {
            "flaws": "covered",
            "strain": "longitudinal",
            "growth_speed": 0.4,
            "growth_range": 3.0,
            "per_flaw": True,
        },
    },
    "talk": {
        "materials": {"basalt": {"friction": 0.945}},  # Klar's cone of 40 deg
        "fracture": {
            "flaws": "2NlnN",
            "strain": "young",
            "growth_speed": 0.5,
            "growth_range": 3.0,
            "per_flaw": False,
        },
    },
}
"""Keys of engine.scene.collision.Collision in which the set-ups differ, by the name of the set."""
