"""The figure of all cases."""

import numpy as np
import pandas as pd
from matplotlib.colors import to_rgb
from matplotlib.patches import Rectangle

from engine.verification.stability.heat_map import COLORS, LOSS, MAP, draw

CASES = pd.DataFrame(
    [("a", "1", "stable", 0.3), ("a", "2", "stopped", 0.9), ("b", "1", "stable", np.nan), ("b", "2", "failed", 0.1)],
    columns=["group", "name", "verdict", "dissipation"],
)


def test_each_case_has_its_rectangle_in_the_row_of_its_group_and_the_colour_of_its_end() -> None:
    axes = draw(CASES).axes[0]
    rectangles = [patch for patch in axes.patches if isinstance(patch, Rectangle)]
    assert [rectangle.get_xy() for rectangle in rectangles] == [(0, 0), (1, 0), (0, 1), (1, 1)]
    colours = [MAP(LOSS(0.3)), COLORS["stopped"], COLORS["energy not known"], COLORS["failed"]]
    assert [to_rgb(rectangle.get_facecolor()) for rectangle in rectangles] == [to_rgb(colour) for colour in colours]
    assert [label.get_text() for label in axes.get_yticklabels()] == ["a", "b"]
    assert [text.get_text() for text in axes.texts] == list(CASES["name"])
