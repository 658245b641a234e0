"""Whole runs that search: their numbers, beside the truth and beside plain rejection, and what is said of them."""

from __future__ import annotations

import math
import shlex
from io import BytesIO
from zipfile import ZipFile

import numpy as np
import pytest
from click.testing import CliRunner
from packed_sheets import packed_sheets
from scipy import optimize, stats
from simulated import simulated

from xlmc.analysis.results.record import make_record
from xlmc.analysis.results.record.make import fingerprint
from xlmc.analysis.results.statements.run_in_words import sampling_sentence
from xlmc.api import Simulation
from xlmc.cli.simulate import show_run
from xlmc.cli.simulate import simulate as command
from xlmc.montecarlo.rare import rare_switch

CELLS = {"A1": 1.0, "A2": 1.0, "B1": "=A1*A2", "C1": "=A1+A2", "C2": "=A1-A2"}
UNIT = {"low": 0, "high": 1}
GIVEN = {"a": {"cell": "A1", **UNIT}, "b": {"cell": "A2", **UNIT}}
EDGE = 0.99
CHANCE = 1 - EDGE + EDGE * math.log(EDGE)
"""P(ab > EDGE), some 5 in 100,000."""

MEAN = 2 * ((1 - EDGE**2) / 2 - EDGE * (1 - EDGE)) / CHANCE
"""Of a + b where ab > EDGE: 2 ∫ a (1 − EDGE/a) da over its chance."""


@pytest.fixture(scope="module")
def model(book):
    return book(CELLS, GIVEN, {"sum": "C1", "difference": "C2"}, {"f": {"cell": "B1", "above": EDGE}})


@pytest.fixture(scope="module")
def run(model):
    return simulated(model, seed=4, until_accepted=2000, rare="always")


def test_the_answer_is_the_truth(run):
    for result, true in ((run.acceptance, CHANCE), (run["sum"].mean, MEAN), (run["difference"].mean, 0.0)):
        assert abs(result.value - true) < 4.5 * result.error
    assert run.accepted == 2000
    assert run.forecasts["sum"].size == run.inputs["a"].size == run.trial_index.size == 2000
    assert np.all(run.inputs["a"] * run.inputs["b"] > EDGE)


def test_plain_rejection_gives_the_same_answer(model, run):
    """The test of the one is the other: 3,000,000 plain trials, 150 of them accepted."""
    plain = simulated(model, 3_000_000, seed=9)
    for name in ("sum", "difference"):
        ours, theirs = run[name].statistics, plain[name].statistics
        for mine, other in ((ours.mean, theirs.mean), (ours.standard_deviation, theirs.standard_deviation)):
            assert abs(mine.value - other.value) < 4.5 * math.hypot(mine.error, other.error)
    assert abs(run.acceptance.value - plain.acceptance.value) < 4.5 * plain.acceptance.error


def test_counts_are_those_of_plain_trials(model, run):
    plain = simulated(model, rare_switch.ALWAYS_FIRST, seed=4)
    assert run.trials == plain.trials == rare_switch.ALWAYS_FIRST
    assert run.tally.rejected.tolist() == plain.tally.rejected.tolist()
    assert run.prior["a"].tobytes() == plain.prior["a"].tobytes()


def test_the_account_adds_up(run):
    rare = run.rare
    assert rare.evaluations == run.trials + rare.learning + rare.proposals + rare.checked
    assert rare.plain == run.trials
    assert rare.plain_accepted == run.trials - run.tally.rejected[0]
    assert 0 < rare.fresh <= rare.proposals // 2
    assert rare.kept == 2000 <= rare.proposals_accepted <= rare.proposals
    assert 0.97 * rare.kept <= rare.size <= rare.kept
    assert rare.lost == rare.faulty == 0
    assert run.warnings == []
    assert run.stopped.reached
    assert f"{rare.proposals:,} further trials" in sampling_sentence(run)
    assert "found in" in repr(Simulation(run))


def test_the_record_says_what_was_done(run):
    record = make_record(run)
    assert record["rare.evaluations"] == run.rare.evaluations
    assert record["rare.acceptance_low"] < record["rare.acceptance"] < record["rare.acceptance_high"]
    assert record["run.repeat"] == "xlmc simulate book.xlsx --until-accepted 2000 --seed 4 --rare always"
    assert "learned proposal" in record["sampling.method_in_words"]


def test_the_same_run_is_the_same_with_threads(model, run):
    again = simulated(model, seed=4, until_accepted=2000, rare="always", jobs=2)
    assert fingerprint(again) == fingerprint(run)
    assert again.rare == run.rare


def test_plain_trials_give_way_where_they_would_not_do(model, monkeypatch):
    monkeypatch.setattr(rare_switch, "FIRST_LOOK", 1 << 16)
    result = simulated(model, 1 << 22, seed=4, until_accepted=500)
    assert result.rare is not None
    assert result.trials >= 1 << 16
    assert shlex.split(make_record(result)["run.repeat"])[3:] == [
        *("--trials", str(1 << 22), "--until-accepted", "500", "--seed", "4")
    ]


def test_plain_trials_stay_where_they_do(model, monkeypatch):
    monkeypatch.setattr(rare_switch, "FIRST_LOOK", 1 << 14)
    result = simulated(model, 1 << 22, seed=4, until_accepted=10)
    assert result.rare is None
    assert result.accepted == 10


@pytest.fixture
def costly(monkeypatch):
    """Plain trials would do, and every search is cheaper."""
    for name, value in (("FIRST_LOOK", 1 << 16), ("COSTLY_FROM", 1 << 16), ("_LEAST_PART", 1), ("SEARCH_PART", 64)):
        monkeypatch.setattr(rare_switch, name, value)


def test_a_search_is_made_where_it_is_cheaper(model, costly, run):
    share = run.rare.acceptance.value
    limit, wanted = 1 << 26, 1000
    assert limit / 64 < wanted / share < limit, "plain trials would do, at a higher cost"
    result = simulated(model, limit, seed=4, until_accepted=wanted)
    assert result.rare is not None
    assert result.rare.evaluations < wanted / share


def test_plain_trials_go_on_after_a_search_that_failed(model, costly, monkeypatch):
    from xlmc.montecarlo.rare import search as module

    tried = []

    def fails(*_):
        tried.append(1)
        return module.Search(np.empty((0, 1)), None, "it failed", 0)

    monkeypatch.setattr(module, "search", fails)
    result = simulated(model, 1 << 24, seed=4, until_accepted=300)
    plain = simulated(model, 1 << 24, seed=4, until_accepted=300, rare="never")
    assert tried == [1]
    assert result.rare is None
    assert result.stopped.reached
    assert result.trial_index.tolist() == plain.trial_index.tolist()


def test_never_is_never(model, monkeypatch):
    monkeypatch.setattr(rare_switch, "FIRST_LOOK", 1 << 14)
    result = simulated(model, 1 << 18, seed=4, until_accepted=5000, rare="never")
    assert result.rare is None
    assert not result.stopped.reached


def test_filters_that_contradict_each_other_end_the_run(book):
    filters = {"high": {"cell": "B1", "above": 0.9}, "low": {"cell": "C1", "below": 1.0}}
    result = simulated(book(CELLS, GIVEN, {"sum": "C1"}, filters), seed=4, until_accepted=10, rare="always")
    assert result.rare is None
    assert result.accepted == 0
    assert result.stopped.by == "search"
    (warning,) = result.warnings
    assert "contradict" in warning
    assert "'high'" in warning or "'low'" in warning


def test_dynamic_correlated_and_whole_numbers_come_along(book):
    """P(c ≥ 3, a + b > 4.5) is a product. Given the sum s, a is normal with the mean s/2, the variance (1 − ρ)/2."""
    cells = {"A1": 1.0, "A2": 1.0, "A3": 1.0, "C1": "=A1+A2", "C2": "=A3*A1"}
    given = {
        "a": {"cell": "A1", "distribution": "Normal", "mean": 0, "std_dev": 1},
        "b": {"cell": "A2", "distribution": "Normal", "mean": 0, "std_dev": 1},
        "c": {"cell": "A3", "distribution": "Poisson", "rate": 1},
    }
    filters = {"f": {"cell": "C1", "above": 4.5}, "g": {"cell": "A3", "at_least": 3}}
    model = book(cells, given, {"x": "C2"}, filters, {("a", "b"): 0.5})
    result = simulated(model, seed=4, until_accepted=1000, rare="always")
    assert np.all(result.inputs["c"] >= 3)
    assert np.all(result.inputs["c"] == np.round(result.inputs["c"]))
    rho, counts = 2 * math.sin(math.pi * 0.5 / 6), np.arange(3, 30)  # 0.5 is of the ranks
    deviation = math.sqrt(2 + 2 * rho)
    sums = np.linspace(4.5, 16, 4_001)
    shares = {"s": stats.norm.pdf(sums, scale=deviation), "c": stats.poisson.pmf(counts, 1)}
    weights = np.outer(shares["s"] / shares["s"].sum(), shares["c"] / shares["c"].sum())

    def below(x):
        return np.sum(weights * stats.norm.cdf(x / counts, sums[:, None] / 2, math.sqrt((1 - rho) / 2)))

    mean = np.sum(weights * np.outer(sums / 2, counts))
    median = optimize.brentq(lambda x: below(x) - 0.5, 3, 30)
    for mine, true in (
        (result["x"].mean, mean),
        (result["x"].median, median),
        (result.acceptance, stats.norm.sf(4.5, scale=deviation) * stats.poisson.sf(2, 1)),
    ):
        assert abs(mine.value - true) < 4.5 * mine.error


def test_a_search_keeps_the_posterior_of_a_reading_that_is_far_off(book):
    """X ~ N(0, 1) and a reading of 4.5 with a standard deviation of 0.5: mean 3.6, SD √0.2."""
    x = {"x": {"cell": "A1", "distribution": "Normal", "mean": 0, "std_dev": 1}, "c": {"cell": "C1", **UNIT}}
    reading = {"EDR": {"cell": "B1", "reading": 4.5, "error": "normal", "std_dev": 0.5}}
    cells = {"A1": 0.0, "B1": "=A1*1", "C1": 2.0, "D1": "=A1+C1"}
    result = simulated(book(cells, x, {"y": "B1", "sum": "D1"}, evidence=reading), until_accepted=2_000, rare="always")
    assert result.rare is not None
    for mine, true in ((result["y"].mean, 3.6), (result["y"].standard_deviation, math.sqrt(0.2))):
        assert abs(mine.value - true) < 4 * mine.error


def test_the_command_line_says_so(tmp_path):
    made = CliRunner().invoke(command, [str(tmp_path / "none.xlsx"), "--rare", "sometimes"])
    assert made.exit_code == 2
    assert "sometimes" in made.output


def test_the_sheets_say_so(run):
    with ZipFile(BytesIO(packed_sheets(run))) as package:
        written = "".join(package.read(name).decode() for name in package.namelist() if name.endswith(".xml"))
    for message in (
        "Evaluated in all",
        "Drawn before the search",
        "drawn before the search for accepted ones began",
        "Search for rare accepted trials",
    ):
        assert message in written
    assert f"{run.rare.evaluations:,} trials" in written


def test_the_command_line_tells_what_was_done(run, capsys):
    show_run(run)
    shown = capsys.readouterr().out
    assert "2,000 accepted trials; a trial is accepted with probability" in shown
    assert f"Trials rejected of {run.trials:,} drawn before the search" in shown
    assert "learned proposal" in shown


def test_the_page_does_not_take_kept_trials_for_a_share_of_the_plain_ones(run):
    from xlmc.outputs.page.sheet_sections import answer

    words = str(answer(run))
    assert f"{run.rare.evaluations:,} combinations of values" in words
    assert "2,000 that pass all filters were kept" in words
    assert f"{run.trials:,} combinations" not in words
