"""Figures are drawn in the look of the project and leave matplotlib as they found it."""

import subprocess
import sys

import matplotlib
import pytest

from analysis.report.figures.style import STYLE, nothing_done

UNTOUCHED = """
import matplotlib
before = matplotlib.rcParams.copy()  # item by item, its backend would be chosen now
import analysis.report.products, analysis.accuracy.figure
import engine.verification.stability.heat_map, engine.verification.accuracy.log_axes
analysis.report.figures.style.nothing_done()
changed = [name for name in before if name != "backend" and matplotlib.rcParams[name] != before[name]]
import sys
assert not changed, changed
assert "matplotlib.pyplot" not in sys.modules
"""


def test_a_figure_has_the_look_and_the_caller_keeps_its_own() -> None:
    with matplotlib.rc_context({"axes.linewidth": 3.0}):
        figure = nothing_done()
        assert matplotlib.rcParams["axes.linewidth"] == 3.0
    assert figure.axes[0].spines["left"].get_linewidth() == pytest.approx(STYLE["axes.linewidth"])


def test_imports_and_figures_change_no_setting_of_matplotlib_and_choose_no_window() -> None:
    result = subprocess.run([sys.executable, "-c", UNTOUCHED], capture_output=True, text=True, check=False)
    assert result.returncode == 0, result.stderr
