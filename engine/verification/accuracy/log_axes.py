"""Labels of logarithmic axes."""

from collections.abc import Iterable

from matplotlib.axis import Axis
from matplotlib.ticker import FormatStrFormatter, LogLocator, NullFormatter


def label_decades(axis: Axis, values: Iterable[float]) -> None:
    """Label powers of ten, and over few decades 2 and 5 times them too, in plain numbers.

    Args:
        axis: a logarithmic axis.
        values: coordinates of what is drawn, along this axis.
    """
    shown = list(values)
    several = max(shown) > 1e3 * min(shown)
    axis.set_major_locator(LogLocator(subs=(1.0,) if several else (1.0, 2.0, 5.0), numticks=8))
    axis.set_major_formatter(FormatStrFormatter("%g"))
    axis.set_minor_formatter(NullFormatter())
