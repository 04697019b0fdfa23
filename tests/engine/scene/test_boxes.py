"""Scenes of boxes, with periodic axes and walls."""

import pytest

from engine.errors import SceneError
from engine.scene.fields import validate
from engine.scene.scene import Scene
from tests.helpers.scenes import box_scene


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"period": [7.0, None, None]}, "multiple"),
        ({"physics": {"gravity": {}, "uniform_gravity": [0.0, 0.0, -1.0]}}, "uniform_gravity"),
        ({"period": [8.0, None, None], "physics": {}}, "self-gravity"),
        ({"physics": {"walls": [{"normal": [0.0, 0.0, 0.0]}]}}, "normal"),
        ({"bodies": [{"size": [1.0, 1.0, 1.0], "lattice": [1, 1, 0]}]}, "lattice"),
    ],
)
def test_wrong_parts_are_refused(change, told):
    table = box_scene().model_dump(mode="json")
    with pytest.raises(SceneError, match=told):
        validate(Scene, {**table, **change}, "scene")


def test_a_scene_of_boxes_survives_its_json():
    scene = box_scene(walls=[{"friction": "stick"}])
    assert Scene.model_validate_json(scene.canonical()) == scene
