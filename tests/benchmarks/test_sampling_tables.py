"""The committed coverage and variance tables: they meet their bars, and the scripts that made them make them again."""

from __future__ import annotations

import importlib.util
import json
import math
import re
from pathlib import Path

import numpy as np
import pytest

from xlmc.montecarlo.sampling.sampling_methods import METHODS

BENCHMARKS = Path(__file__).resolve().parents[2] / "benchmarks"


def script(name):
    """By its path."""
    spec = importlib.util.spec_from_file_location(f"script_{name}", BENCHMARKS / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def coverage():
    return script("interval_coverage")


@pytest.fixture(scope="module")
def sobol():
    return script("sobol")


def page_table(page, name):
    return re.search(rf"<!-- {name} -->\n\n(.*?)\n\n<!-- /{name} -->", page.read_text(encoding="utf-8"), re.DOTALL)[1]


def test_the_committed_table_meets_the_bar(coverage):
    result = json.loads(coverage.RESULTS.read_text(encoding="utf-8"))
    cells = [coverage.Cell(*each) for each in result["cells"]]
    assert result["runs"] == 4_000
    assert {(cell.problem, cell.method) for cell in cells} == {(p, m) for p in coverage.PROBLEMS for m in METHODS}
    assert coverage.faults(cells, result["runs"]) == []
    assert page_table(coverage.PAGE, "coverage") == coverage.table(result)


@pytest.fixture(scope="module")
def tails():
    return script("tail_coverage")


def test_the_committed_table_of_tails_meets_its_bar(tails):
    result = [tails.Cell(*each) for each in json.loads(tails.RESULTS.read_text(encoding="utf-8"))["cells"]]
    assert {(cell.problem, cell.method) for cell in result} == {(p, m) for p in tails.PROBLEMS for m in tails.SAMPLING}
    assert len(result) == len(tails.PROBLEMS) * len(tails.SAMPLING) * len(tails.TRIALS)
    assert tails.faults(result) == []
    assert page_table(tails.PAGE, "tail-coverage") == tails.tables(result)


def test_the_bar_of_tails_can_be_missed(tails):
    ordinary = tails.Cell("kink", "mc", 10_000, 4_000, [3_600] * 6, [0, 300, 0, 0, 0, 0], [1.0] * 5 + [1.5])
    missed = tails.faults([ordinary])
    assert missed[0] == "kink, mc, 10,000 trials, mean: held in 90.0%, told in 0.0%"
    assert missed[2] == "kink, mc, 10,000 trials, SD: told in 7.5%"
    assert missed[-1] == "kink, mc, 10,000 trials, share: 1.50 times as long as need be"
    expected = tails.Cell("lognormal, σ 1.5", "mc", 1_000, 4_000, [3_600] * 6, [3_900] * 6, [3.0] * 6)
    assert tails.faults([expected]) == []
    quiet = expected._replace(silent=[0, 400, 0, 0, 0, 0])
    (message,) = tails.faults([quiet])
    assert message == "lognormal, σ 1.5, mc, 1,000 trials, SD: missed without a notice in 10.0%"


@pytest.mark.parametrize("method", ["mc", "lhs", "sobol"])
def test_many_runs_at_once_have_the_numbers_of_each_alone(tails, method):
    """`measure` compares the first run with xlmc's own functions, and ends with an error where they differ."""
    result = tails.measure(method, 1_000, range(40, 42))
    assert result.shape == (len(tails.PROBLEMS), 2, 6, 4)
    for cell in tails.cells(method, 1_000, result):
        assert cell.runs == 2


def test_the_bar_can_be_missed(coverage):
    cell = coverage.Cell("speed", "mc", (3_700, 3_800, 3_760, 3_941, 3_939), 1, None, 0, 1)
    assert coverage.faults([cell], 4_000) == ["speed, mc, mean: 92.50%", "speed, mc, 24.5 %: 98.52%"]


KEPT = ("speed, 3 % kept", "speed, 33 % kept")


@pytest.mark.parametrize(("method", "name"), [(method, KEPT[n % 2]) for n, method in enumerate(METHODS)])
def test_some_of_the_runs_again(coverage, method, name):
    """20 runs with other seeds: 95 % ± 4 binomial standard errors, which 100 % is within, so from below only."""
    runs = 20
    cell = coverage.measure(name, method, runs, first=50_000)
    assert min(cell.hits) > runs * (0.95 - 4 * math.sqrt(0.95 * 0.05 / runs))


@pytest.mark.parametrize(
    ("name", "trials"),
    [
        ("sum of normals, 16 % kept", 50_000),
        ("speed", 25_000),
        ("speed, 33 % kept", 25_000),
        ("speed, 3 % kept", 250_000),
    ],
)
def test_the_truths_are_true(coverage, name, trials):
    """Beside a Monte Carlo run with more than 6,000 accepted trials: within 4.5 of its errors."""
    problem = coverage.PROBLEMS[name]
    sample = coverage.one_run(problem, coverage.SamplingPlan.of("mc", trials), 77)
    assert sample.n > 6_000
    for estimate, truth in zip(coverage.estimates(sample), problem.truth(), strict=True):
        assert abs(estimate.value - truth) < 4.5 * estimate.error


def test_the_committed_gains_meet_the_bar(sobol):
    result = json.loads(sobol.RESULTS.read_text(encoding="utf-8"))
    assert result["trials"] == 131_072
    for case, least in sobol.LEAST.items():
        ratios, _ = result["gains"][case]["sobol"]
        assert ratios[-1] >= least
    assert page_table(sobol.PAGE, "sobol") == sobol.table(result)


def test_gains_of_known_variances(sobol, monkeypatch):
    """A variance ratio of 4 from 1,000 seeds is known to 6.3 %: four of those."""
    monkeypatch.setattr(sobol, "RESAMPLES", 400)
    rng = np.random.default_rng(1)
    ratios, intervals = sobol.gains(2 * rng.normal(size=(1_000, 2)), rng.normal(size=(1_000, 2)))
    assert ratios == pytest.approx([4.0] * 3, rel=0.25)
    assert all(low < ratio < high < 1.3 * ratio for ratio, (low, high) in zip(ratios, intervals, strict=True))


def test_unfiltered_sobol_means_of_the_case_study_hardly_vary(sobol):
    """Six seeds and a sixteenth of the trials: the ratios are still far above the bar of 1,000."""
    book = sobol.load(sobol.CASE_STUDY)
    free = sobol.CompiledModel(book.workbook, sobol.replace(book.definitions, filters=()), book.path)
    plain, even = (sobol.means(free, method, range(6), 1 << 13) for method in ("mc", "sobol"))
    assert (plain.var(axis=0) > 1_000 * even.var(axis=0)).all()


@pytest.fixture(scope="module")
def shares():
    return script("share_coverage")


def test_the_committed_table_of_shares_meets_its_bar(shares):
    cells = [shares.Cell(*each) for each in json.loads(shares.RESULTS.read_text(encoding="utf-8"))["cells"]]
    assert [(cell.problem, cell.trials) for cell in cells] == [(p, n) for p in shares.PROBLEMS for n in shares.TRIALS]
    assert shares.faults(cells) == []
    assert page_table(shares.PAGE, "share-coverage") == shares.table(cells)


def test_the_bar_of_shares_can_be_missed(shares):
    step = shares.Cell("step at 90 %", 3_500, 100, 0.8, 0.7, 60, 70, 20, 0, 0.9)
    straight = shares.Cell("straight, 0.3", 3_500, 100, 0.3, 0.3, 95, 95, 30, 95, 1.4)
    assert len(shares.faults([step])) == 1
    assert len(shares.faults([straight])) == 2


@pytest.mark.parametrize("name", ["step at 97 %", "sine, filtered"])
def test_shares_of_a_few_runs_hold(shares, name):
    cell = shares.measure(name, 3_500, 20)
    assert cell.bounded >= 16
    assert cell.before <= 2
