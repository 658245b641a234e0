"""The case study from Python: load, run, ask, and use the model as a function.

Run it from anywhere: python examples/python_api.py
"""

from __future__ import annotations

from pathlib import Path

import xlmc

model = xlmc.load(Path(__file__).with_name("intersection.xlsx"))
run = model.simulate(trials=200_000, seed=999)

print(f"{run.accepted} of {run.trials} trials accepted")
for name, forecast in run.results.items():
    low, high = forecast.central(0.51)
    mean, spread = forecast.mean, forecast.standard_deviation
    print(
        f"{name}: mean {mean.value:.2f} ± {mean.error:.2f} mph, standard deviation {spread.value:.2f}, "
        f"51 % range {low.value:.1f} to {high.value:.1f}"
    )

speeding = run["Chevrolet impact speed"].probability_above(35)
print(f"P(Chevrolet faster than 35 mph) = {speeding.value:.1%} ± {speeding.error:.1%}")

trials = run.frame()  # pandas: one row per accepted trial
print(trials[["Chevrolet approach angle", "Nissan impact speed"]].corr(method="spearman").round(2))

# The workbook as a vectorised function of its assumptions: here, one assumption varied with all others at base.
base = {assumption.name: assumption.base for assumption in model.live}
angles = [182.0, 186.0, 190.0]
speeds = model.function({**base, "Chevrolet approach angle": angles})["Nissan impact speed"]
for angle, speed in zip(angles, speeds, strict=True):
    print(f"approach angle {angle:.0f}°: Nissan at {speed:.1f} mph (all else at base, unfiltered)")
