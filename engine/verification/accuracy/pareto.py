"""The Pareto front: runs that no other beats in both error and CPU time."""

import numpy as np
import pandas as pd


def pareto(runs: pd.DataFrame) -> pd.DataFrame:
    """Return the runs that are more accurate than every faster one, fastest first.

    Args:
        runs: any table with the columns `cpu_time` and `error`.
    """
    ordered = runs.sort_values(["cpu_time", "error"])
    best = np.minimum.accumulate(np.asarray(ordered["error"], dtype=float))
    return ordered[(ordered["error"] == best) & ~pd.Series(best, index=ordered.index).duplicated()]
