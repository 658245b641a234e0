"""What a typed program of a user looks like; mypy and pyright check it in their strict modes.

Usage: `python examples/typed_usage.py`.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import xlmc

Floats = NDArray[np.float64]

BOOK = Path(__file__).parent / "intersection.xlsx"


def of_a_workbook(path: Path) -> xlmc.Simulation:
    """Run a workbook with one range replaced and one assumption held."""
    model: xlmc.Model = xlmc.load(path)
    changed = model.with_(nissan_weight=xlmc.Uniform(3_300, 3_600, units="lb", source="scales"), trials=20_000)
    return changed.frozen("Chevrolet weight").simulate(seed=1)


def skid(friction: Floats, distance: Floats) -> dict[str, Floats]:
    """Return the speed at the beginning of a skid, in km/h, from metres."""
    speed: Floats = 3.6 * np.sqrt(2 * 9.80665 * friction * distance)
    return {"Speed": speed}


def of_a_function() -> xlmc.Estimate:
    """Return the mean of a model without a workbook."""
    model = xlmc.model(
        skid,
        {"friction": xlmc.Triangular(0.6, 0.7, 0.8), "distance": xlmc.Normal(25, 0.5, units="m")},
        forecasts={"Speed": {"units": "km/h", "threshold": 70}},
        filters={"Speed": {"above": 50, "because": "the recorder"}},
    )
    run = model.simulate(20_000, seed=1)
    answer: xlmc.ForecastResult = run["Speed"]
    low, high = answer.central(0.51)
    assert low.value < answer.quantile(0.5).value < high.value
    return answer.mean


if __name__ == "__main__":
    run = of_a_workbook(BOOK)
    print(run["Nissan delta-V"].mean, run.frame().attrs["units"]["Nissan delta-V"])
    print(of_a_function())
