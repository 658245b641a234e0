"""Statistics of 0, 1, 2, 3 and 10 accepted trials: a number or none, honest intervals, and nothing that falls over."""

from __future__ import annotations

import math
import re
import zipfile

import numpy as np
import pytest
import xlsxwriter
from click.testing import CliRunner
from simulated import simulated

import xlmc.montecarlo.statistics as xs
from xlmc.cli import xlmc as command
from xlmc.montecarlo.model.loading import load

RUNS = 150
NOISE = 4 * math.sqrt(0.95 * 0.05 / RUNS)
COUNTS = [0, 1, 10]

DEFINED_FROM = {
    # statistic: accepted trials from which it is a number, has an error, has an interval
    "mean": (1, 2, 2),
    "median": (1, 6, 6),
    "mode": (1, 16, 16),
    "standard_deviation": (2, 2, 2),
    "variance": (2, 2, 2),
    "skewness": (2, 3, 3),
    "kurtosis": (2, 4, 4),
    "coefficient_of_variation": (2, 2, 2),
    "minimum": (1, None, None),
    "maximum": (1, None, None),
    "range_width": (1, None, None),
    "mean_standard_error": (2, 2, 2),
}
"""One trial has no spread; two are always symmetric, three have one kurtosis: those are numbers, but no measurements.
With 5 trials the median lies outside them all in 1 of 16 runs, so 95 % confidence needs 6."""


@pytest.mark.parametrize("n", [0, 1, 2, 3, 4, 5, 6, 10, 16])
def test_what_is_defined(n):
    result = xs.describe(np.random.default_rng(n).normal(5.0, 1.0, n), threshold=5.0)
    assert result.trials == n
    for name, (number, error, interval) in DEFINED_FROM.items():
        estimate = getattr(result, name)
        assert math.isnan(estimate.value) == (n < number), name
        assert (estimate.error is not None) == (error is not None and n >= error), name
        assert (estimate.interval is not None) == (interval is not None and n >= interval), name
        assert estimate.n == n
    assert math.isnan(result.probability_above.value) == (n == 0)
    if n:
        low, high = result.probability_above.interval
        assert 0 <= low <= result.probability_above.value <= high <= 1
        assert result.minimum.value <= result.median.value <= result.maximum.value


LEAST = {
    # accepted trials: coverage of a normal, a uniform, an exponential forecast that is measured, less noise
    "mean": {2: (0.95, 0.91, 0.88), 3: (0.95, 0.90, 0.88), 10: (0.95, 0.94, 0.89)},
    "24.5 %": {3: (0.95,) * 3, 10: (0.95,) * 3},
    "75.5 %": {3: (0.95,) * 3, 10: (0.95,) * 3},
    "median": {10: (0.95,) * 3},
    "P(above)": {2: (0.90,) * 3, 3: (0.95,) * 3, 10: (0.92,) * 3},
    "standard deviation": {2: (0.98,) * 3, 3: (0.95, 0.97, 0.88), 10: (0.90, 0.93, 0.72)},
}
"""Means hold for normal forecasts exactly, percentiles for all; standard deviations of skewed forecasts do not."""


@pytest.mark.parametrize(("n", "place"), [(2, 0), (2, 2), (3, 1), (10, 0), (10, 2)])
def test_intervals_are_as_honest_as_the_docs_say(n, place):
    from stressing.few import FORECASTS, coverage

    result = coverage(list(FORECASTS)[place], n, RUNS)["found"]
    for statistic, expected in LEAST.items():
        if n in expected:
            given, held = result[statistic]
            assert given > 0.5 * RUNS
            assert held / given > expected[n][place] - NOISE, statistic


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Books whose filter accepts so many of 2,000 trials."""
    folder = tmp_path_factory.mktemp("few")
    draws = simulated(_load(folder, 1.0), 2_000, 1).inputs["u"]
    limits = np.sort(draws)
    for n in COUNTS:
        _write(folder / f"{n}.xlsx", float((limits[n - 1] + limits[n]) / 2 if n else -1.0))
    return folder


def _load(folder, below):
    _write(folder / "all.xlsx", below)
    return load(folder / "all.xlsx")


def _write(path, below):
    with xlsxwriter.Workbook(path) as book:
        sheet = book.add_worksheet("Model")
        tables = {
            (0, 0, "xlmc_assumptions"): (["Name", "Value", "Low", "High"], [["u", 0.5, 0, 1], ["v", 1.5, 1, 2]]),
            (0, 6, "xlmc_forecasts"): (
                ["Name", "Value", "Threshold"], [["sum", "=B2+B3", 1.5], ["ratio", "=B2/B3", ""]]
            ),
            (0, 11, "xlmc_filters"): (["Name", "Value", "Below"], [["f", "=B2", below]]),
        }  # fmt: skip
        for (row, column, name), (headings, rows) in tables.items():
            for down, values in enumerate(rows, 1):
                for along, value in enumerate(values):
                    sheet.write(row + down, column + along, value)
            options = {"name": name, "columns": [{"header": heading} for heading in headings]}
            sheet.add_table(row, column, row + len(rows), column + len(headings) - 1, options)


@pytest.mark.parametrize("n", [0, 1, 10])
def test_the_command_writes_its_sheets_and_says_that_they_are_few(folder, n):
    target = folder / f"{n}-results.xlsx"
    done = CliRunner().invoke(
        command, ["simulate", str(folder / f"{n}.xlsx"), "-n", "2000", "--seed", "1", "-o", str(target)]
    )
    assert done.exit_code == (1 if n == 0 else 0), done.output
    assert "Traceback" not in done.output
    assert f"Accepted {n} of 2,000 trials" in done.output
    message = "no trial was accepted" if n == 0 else "Only 1 trial was" if n == 1 else f"Only {n} trials were accepted"
    assert message in " ".join(done.output.split())
    with zipfile.ZipFile(target) as package:
        names = re.findall(r'<sheet name="([^"]+)"', package.read("xl/workbook.xml").decode())
        parts = [name for name in package.namelist() if name.startswith(("xl/worksheets/", "xl/sharedStrings"))]
        texts = [text for name in parts for text in re.findall(r">([^<>]+)<", package.read(name).decode())]
    assert {"Results", "Statistics", "Assumptions", "Trials", "Record"} <= set(names)
    assert "no trial was accepted" in " ".join(texts) if n == 0 else len(texts) > 1_000
    assert [text for text in texts if text.strip().lower() in ("nan", "inf", "-inf")] == []


def test_the_notice_ends_where_there_are_enough(book):
    given = {"u": {"cell": "A1", "low": 0.0, "high": 1.0}}
    model = book({"A1": 0.5, "B1": "=A1"}, given, {"x": "B1"})
    assert "Only 99 trials were accepted" in str(simulated(model, 99).notices_of_run[0])
    assert simulated(model, 100).notices_of_run == ()
