"""The paper's case study against the converged reference: 2·10⁹ trials, computed independently of this project.

Each number must lie within 4 standard errors of the reference, the errors of run and reference combined. 17 numbers
at two sizes: the chance that a right program fails is below 0.3 %, and the seeds are fixed.
"""

from __future__ import annotations

from pathlib import Path

import pytest
from simulated import simulated

from xlmc.montecarlo.model.loading import load

BOOK = Path(__file__).resolve().parents[1] / "examples" / "intersection.xlsx"

ACCEPTANCE = 0.01756579, 0.0000029
"""Reference value and its standard error."""

# Forecast -> mean, its standard error, SD, 24.5 % and 75.5 % quantile, mph.
REFERENCE = {
    "Chevrolet delta-V": (11.80333, 0.00012, 0.73709, 11.2793, 12.3532),
    "Nissan delta-V": (23.06344, 0.00024, 1.41424, 22.0565, 24.1252),
    "Chevrolet impact speed": (33.16317, 0.00030, 1.76307, 31.7987, 34.4853),
    "Nissan impact speed": (4.74205, 0.00034, 2.00052, 3.3507, 6.1320),
}
SD_ERROR = 0.0003
QUANTILE_ERROR = 0.0005

# The paper's Table 2: mean, SD, both ends of the 51 % range, as printed, one decimal each.
TABLE_2 = {
    "Chevrolet delta-V": (11.8, 0.7, 11.3, 12.4),
    "Nissan delta-V": (23.1, 1.4, 22.0, 24.1),
    "Chevrolet impact speed": (33.1, 1.8, 31.8, 34.5),
    "Nissan impact speed": (4.8, 2.0, 3.3, 6.2),
}


SIZES = None, 2_000_000


@pytest.fixture(scope="module")
def model():
    return load(BOOK)


@pytest.fixture(scope="module")
def runs(model):
    """By the number of trials: the book's own, and ten times as many."""
    return {trials: simulated(model, trials=trials, jobs=2) for trials in SIZES}


def near(estimate, value, error):
    return abs(estimate.value - value) <= 4 * (estimate.error**2 + error**2) ** 0.5


def test_default_settings(model):
    settings = model.definitions.settings
    assert (settings.trials, settings.seed, settings.sampling) == (200_000, 999, "mc")


@pytest.mark.parametrize("trials", SIZES)
def test_acceptance(runs, trials):
    run = runs[trials]
    assert near(run.acceptance, *ACCEPTANCE)


@pytest.mark.parametrize("trials", SIZES)
@pytest.mark.parametrize("name", REFERENCE)
def test_the_four_numbers_of_each_forecast(runs, trials, name):
    run = runs[trials]
    mean, mean_error, deviation, low, high = REFERENCE[name]
    result = run[name]
    assert near(result.mean, mean, mean_error)
    assert near(result.standard_deviation, deviation, SD_ERROR)
    results = result.central(0.51)
    assert near(results[0], low, QUANTILE_ERROR)
    assert near(results[1], high, QUANTILE_ERROR)


@pytest.mark.parametrize("trials", SIZES)
@pytest.mark.parametrize("name", TABLE_2)
def test_the_papers_own_table(runs, trials, name):
    """The paper printed one decimal from 3481 trials: half a unit of rounding, and 4 of its own standard errors."""
    result = runs[trials][name]
    paper_error = (result.values.size / 3481) ** 0.5
    results = (result.mean, result.standard_deviation, *result.central(0.51))
    for estimate, printed in zip(results, TABLE_2[name], strict=True):
        assert abs(estimate.value - printed) <= 0.05 + 4 * estimate.error * (1 + paper_error**2) ** 0.5


def test_more_trials_begin_with_the_200_000(runs):
    short, long = runs.values()
    m = short.accepted
    assert (long.trial_index[:m] == short.trial_index).all()
    assert long.trial_index[m] >= 200_000
    for name, values in short.forecasts.items():
        assert (long.forecasts[name][:m] == values).all()


def test_threads_change_no_bit(model, runs):
    one, two = simulated(model, jobs=1), runs[None]
    assert (one.trial_index == two.trial_index).all()
    for name in one.forecasts:
        assert (one.forecasts[name] == two.forecasts[name]).all()
    for name in one.inputs:
        assert (one.inputs[name] == two.inputs[name]).all()


def test_the_reference_engine_agrees(model):
    """`formulas` computes cell by cell with the same libm: the two differ by the order of a few operations."""
    fast, slow = (simulated(model, 3, 1959, engine=engine) for engine in ("numpy", "formulas"))
    assert fast.accepted == 2
    assert (fast.trial_index == slow.trial_index).all()
    for name, values in fast.forecasts.items():
        assert slow.forecasts[name] == pytest.approx(values, rel=1e-12)


def test_verify_finds_every_cell_right():
    from xlmc.analysis.studies.verify import Status, verify
    from xlmc.excel.workbook.reader import read_workbook

    result = verify(read_workbook(BOOK))
    assert result.count(Status.MATCHED) == len(result.cells) > 70
