"""The matrix of stability by name, its recorded verdicts, and the measures of a calm run."""

from pathlib import Path

import pandas as pd

from engine.verification.stability import heat_map
from engine.verification.stability.cases import all_cases
from engine.verification.stability.measures import Measures

BY_NAME = {(case.group, case.name): case for case in all_cases()}
RECORDED = Path(heat_map.__file__).with_name("stability.csv")

TOO_FAR = ("position", "leaves the grid's range")
TOO_LONG = ("Courant number", "5")

CALM = Measures(0.0, 1e-16, 1e-14, 0.01, 0.1, 200.0, 2000.0, 1.2, 3.0)
"""Within all bounds, half of the nearest."""


def recorded() -> pd.DataFrame:
    return pd.read_csv(RECORDED, dtype={"name": str}, keep_default_na=False).set_index(["group", "name"])
