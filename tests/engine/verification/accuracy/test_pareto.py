"""The Pareto front of error and CPU time."""

import pandas as pd

from engine.verification.accuracy.pareto import pareto


def test_pareto_front() -> None:
    runs = pd.DataFrame({"cpu_time": [4.0, 1.0, 2.0, 3.0, 3.0], "error": [1.0, 9.0, 9.0, 4.0, 5.0]})
    assert pareto(runs).index.tolist() == [1, 3, 0]
