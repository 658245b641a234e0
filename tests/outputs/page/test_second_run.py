"""A second run on the page: its numbers, the differences with their errors, and what the runs were given."""

from __future__ import annotations

import math
from pathlib import Path
from types import SimpleNamespace

import pytest
from fewer_sheets import leave_out_fits
from simulated import simulated

from xlmc.montecarlo.model.loading import load
from xlmc.montecarlo.statistics import Estimate
from xlmc.outputs.page import page_text
from xlmc.outputs.page.second_run import _numbers

BOOKS = Path(__file__).resolve().parents[3] / "examples"


MEAN, SPREAD, LOW, HIGH, ABOVE, YES = (Estimate(float(value), 0.1) for value in range(6))


def _row(**more):
    usual = {"mean": MEAN, "standard_deviation": SPREAD, "low": LOW, "high": HIGH, "share": 0.9}
    return SimpleNamespace(**{**usual, "yes": None, "above": ABOVE, "threshold": None, **more})


@pytest.mark.parametrize(
    ("first", "second", "compared"),
    [
        ({}, {}, ["Mean", "Standard deviation", "Central 90 % from", "to"]),
        ({"share": 0.9}, {"share": 0.8}, ["Mean", "Standard deviation"]),
        (
            {"threshold": 1.5},
            {"threshold": 1.5},
            ["Mean", "Standard deviation", "Central 90 % from", "to", "Above 1.5"],
        ),
        ({"threshold": 1.5}, {"threshold": 2.5}, ["Mean", "Standard deviation", "Central 90 % from", "to"]),
        ({"threshold": 1.5}, {}, ["Mean", "Standard deviation", "Central 90 % from", "to"]),
        (
            {"threshold": 1.5, "above": None},
            {"threshold": 1.5},
            ["Mean", "Standard deviation", "Central 90 % from", "to"],
        ),
        ({"yes": YES}, {"yes": YES}, ["Yes"]),
        ({"yes": YES}, {}, ["Mean", "Standard deviation", "Central 90 % from", "to"]),
        ({}, {"yes": YES}, ["Mean", "Standard deviation", "Central 90 % from", "to"]),
    ],
)
def test_which_numbers_of_two_runs_can_be_compared(first, second, compared):
    values = {"Mean": MEAN, "Standard deviation": SPREAD, "Central 90 % from": LOW, "to": HIGH, "Yes": YES}
    assert list(_numbers(_row(**first), _row(**second))) == [
        (name, *[values.get(name, ABOVE)] * 2, name in ("Yes", "Above 1.5")) for name in compared
    ]


@pytest.fixture(scope="module")
def runs():
    first, second = (load(BOOKS / name) for name in ("intersection.xlsx", "intersection-momentum.xlsx"))
    return simulated(first, 30_000), simulated(second, 2_000, seed=7)


@pytest.fixture(scope="module")
def section(runs, page_of):
    first, second = runs
    with pytest.MonkeyPatch.context() as patch:
        leave_out_fits(patch)
        (result,) = page_of(first, beside=second).all("section", id="second")
    return result


def test_both_answers_and_their_differences(runs, section):
    first, second = runs
    answers, _ = section.all("table")
    expected = []
    for name, mine in first.results.items():
        theirs = second[name]
        for one, other in (
            (mine.mean, theirs.mean),
            (mine.standard_deviation, theirs.standard_deviation),
            *zip(mine.central(), theirs.central(), strict=True),
        ):
            expected += [one.value, other.value, other.value - one.value]
    assert answers.numbers == expected
    assert "%" not in "".join(cell.text for cell in answers.all("td", class_="number"))
    mean = first["Nissan delta-V"].mean, second["Nissan delta-V"].mean
    error = math.hypot(mean[0].error, mean[1].error)
    assert f" ± {error:.2g}" in answers.text
    assert "Energy lost" in next(each.text for each in section.all("p") if "second run alone" in each.text)


def test_what_the_runs_were_given(section):
    _, given = section.all("table")
    rows = {
        (row.all("td")[0].text, row.all("th")[0].text): [cell.text for cell in row.all("td")[1:]]
        for row in given.all("tbody")[0].all("tr")
    }
    assert rows["Run", "Seed"] == ["999", "7"]
    assert rows["Run", "Trials"] == ["30,000", "2,000"]
    assert rows["Filter", "Restitution, normal"] == ["at least 0 and below 1", "—"]
    assert rows["Assumption", "Nissan impact centre x"] == ["Uniform: Low -3.2, High 3.2", "—"]
    assert ("Assumption", "Nissan weight") not in rows  # the same in both


def test_a_run_beside_itself_differs_in_nothing(run, page_of, monkeypatch):
    leave_out_fits(monkeypatch)
    page = page_of(run, beside=run)
    assert page_text(run, beside=run) == page_text(run, beside=run)
    (section,) = page.all("section", id="second")
    (answers,) = section.all("table")
    assert set(answers.numbers[2::3]) == {0.0}
    assert "the same assumptions and filters" in section.text
    assert "Of the" not in section.text


def test_without_a_second_run_the_page_has_no_such_section(run, page_of):
    assert page_of(run).all("section", id="second") == []
