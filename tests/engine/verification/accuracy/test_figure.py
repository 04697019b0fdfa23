"""The figure of error against CPU time."""

import pandas as pd
from matplotlib.axes import Axes

from engine.verification.accuracy.figure import draw
from engine.verification.accuracy.settings import TRADEOFFS

RUNS = pd.DataFrame(
    [
        ("column", "cells", "16", 0.1, 2.0),
        ("column", "cells", "8", 0.4, 1.0),
        ("column", "cells", "128", 0.3, 9.0),
        ("column", "numerics.cfl", "0.5", 0.2, 3.0),
        ("cliff", "cells", "5", 0.1, 4.0),
    ],
    columns=["scene", "setting", "value", "error", "cpu_time"],
)


def lines(axes: Axes) -> dict[str, list[tuple[float, float]]]:
    return {str(line.get_label()): [(float(x), float(y)) for x, y in line.get_xydata()] for line in axes.get_lines()}


def test_each_scene_has_a_panel_with_its_settings_in_the_order_of_their_values() -> None:
    figure = draw(RUNS)
    column, cliff = (axes for axes in figure.axes if axes.axison)
    assert [axes.get_title() for axes in (column, cliff)] == ["column", "cliff"]
    assert column.get_ylabel() == TRADEOFFS["column"].quantity
    shown = lines(column)
    assert shown["particles, cells or steps"] == [(1.0, 0.4), (2.0, 0.1), (9.0, 0.3)]
    assert shown["numerics.cfl"] == [(3.0, 0.2)]
    assert shown["no run beats these"] == [(1.0, 0.4), (2.0, 0.1)]


def test_a_setting_has_one_colour_and_one_entry_in_the_legend() -> None:
    figure = draw(RUNS)
    colours = [axes.get_lines()[0].get_color() for axes in figure.axes if axes.axison]
    assert colours[0] == colours[1]
    names = [text.get_text() for text in figure.legends[0].get_texts()]
    assert sorted(names) == ["no run beats these", "numerics.cfl", "particles, cells or steps"]
