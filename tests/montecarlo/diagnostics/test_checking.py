"""Checks at the base case and in accepted trials, against the same conditions computed with NumPy."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from simulated import simulated

from xlmc.errors import DefinitionError, FormulaError
from xlmc.excel.address import parse_address
from xlmc.montecarlo.definitions.definitions import Check
from xlmc.montecarlo.diagnostics.checking import LEAST_CHECKED, base_checks, checks_sentence
from xlmc.montecarlo.model.loading import load
from xlmc.montecarlo.model.model import CompiledModel

CELLS = {"A1": 0.75, "A2": 3.0, "A3": 0.5, "B1": "=A1*2", "C1": "=A1<0.9", "C2": "=1/(A1-0.75)>0", "C3": "=A1"}
INPUTS = {"friction": {"cell": "A1", "low": 0.6, "high": 1.0}}


@pytest.fixture
def checked(book):
    """A model with checks by name -> address or (address, because)."""

    def make(cells, checks, assumptions=INPUTS, forecasts=None, filters=None):
        plain = book(cells, assumptions, forecasts or {"twice": "B1"}, filters)
        given = {name: each if isinstance(each, tuple) else (each, "") for name, each in checks.items()}
        rows = tuple(
            Check(name, parse_address(address, "S"), parse_address(address, "S"), because)
            for name, (address, because) in given.items()
        )
        return CompiledModel(plain.workbook, replace(plain.definitions, checks=rows), plain.path)

    return make


@pytest.mark.parametrize(
    ("formula", "result", "holds"),
    [
        ("=A1<0.9", "TRUE", True),
        ("=A1>0.9", "FALSE", False),
        ("=IF(A1<0.9,1,0)", "TRUE", True),
        ("=A1*0", "FALSE", False),
        ("=A1", "0.75, neither TRUE nor FALSE", False),
        ("=2*(A1<0.9)", "2, neither TRUE nor FALSE", False),
        ("=1/(A1-0.75)>0", "#DIV/0!", False),
        ("=SQRT(A1-1)>0", "#NUM!", False),
        ('=IF(A1<0.9,"ok","no")', "a text, not the logical TRUE", False),
        ('=IF(A1<0.9,"TRUE","FALSE")', "a text, not the logical TRUE", False),
        ("=1+1E-12*(A1<0.9)", "1.000000000001, neither TRUE nor FALSE", False),
        ("=1E-300*A1", "7.5e-301, neither TRUE nor FALSE", False),
        ("=1+2*2^-52", "1.0000000000000004, neither TRUE nor FALSE", False),
        ("=IFERROR(1/(A1-0.75)>0,TRUE)", "TRUE", True),
    ],
)
def test_what_a_check_holds_at_the_base_case(checked, formula, result, holds):
    (check,) = base_checks(checked({**CELLS, "C1": formula}, {"plausible": "C1"}))
    assert (check.content, check.holds) == (result, holds)
    assert holds or check.fault == f"the base case fails the check 'plausible': S!C1 is {result}"


@pytest.mark.parametrize("because", ["FALSE: a percentage?", "a percentage?", " false: a percentage? "])
def test_the_reason_is_said_without_its_false(checked, because):
    (check,) = base_checks(checked({**CELLS, "C1": "=A1>0.9"}, {"plausible": ("C1", because)}))
    assert check.fault.endswith("S!C1 is FALSE: a percentage?")


def test_failing_trials_are_counted_as_numpy_counts_them(checked):
    model = checked({**CELLS, "C2": "=SQRT(A1-0.7)>0"}, {"below": "C1", "rooted": "C2"})
    run = simulated(model, trials=30_000, seed=4)
    below, rooted = run.checks
    drawn = run.inputs["friction"]
    assert below.trials == rooted.trials == run.accepted == 30_000
    assert below.failed == np.count_nonzero(drawn >= 0.9)
    assert rooted.failed == np.count_nonzero(drawn <= 0.7)
    assert (below.value_text, rooted.value_text) == ("FALSE", "#NUM!")
    assert below.share.value == below.failed / 30_000
    assert below.share.error == pytest.approx(np.sqrt(below.share.value * (1 - below.share.value) / 30_000))
    assert "first with #NUM!" in rooted.warnings[0]


def test_only_accepted_trials_count(checked):
    filters = {"low": {"cell": "A1", "below": 0.9}}
    run = simulated(checked(CELLS, {"below": "C1"}, filters=filters), trials=5_000)
    assert run.checks[0].failed == 0
    assert run.checks[0].trials == run.accepted < 5_000
    assert run.warnings == []


def test_a_share_above_a_thousandth_is_a_warning_and_stands_first(checked):
    cells = {**CELLS, "B1": "=1/ROUND(A1-0.8,2)"}
    run = simulated(checked(cells, {"below": "C1"}, forecasts={"twice": "B1"}), trials=5_000)
    assert "accepted trials" in run.warnings[0]
    assert "fail the check" in run.warnings[0]
    assert any("lost to errors" in warning for warning in run.warnings[1:])


def test_a_share_below_a_thousandth_is_listed_only(checked):
    run = simulated(checked({**CELLS, "C1": "=A1<0.99995"}, {"below": "C1"}), trials=60_000)
    assert 0 < run.checks[0].failed <= 60
    assert run.warnings == []


@pytest.mark.parametrize("engine", ["numpy", "formulas"])
def test_checks_leave_the_run_as_it_was(book, checked, engine):
    plain = simulated(book(CELLS, INPUTS, {"twice": "B1"}), trials=300, engine=engine)
    with_checks = simulated(checked(CELLS, {"below": "C1"}), trials=300, engine=engine)
    np.testing.assert_array_equal(plain.trial_index, with_checks.trial_index)
    np.testing.assert_array_equal(plain.forecasts["twice"], with_checks.forecasts["twice"])
    assert list(plain.inputs) == list(with_checks.inputs)


def test_an_assumption_that_only_a_check_needs_is_held_at_its_base_value(checked):
    cells = {**CELLS, "C1": "=AND(A1<2,A3<0.6)"}
    inputs = {**INPUTS, "extra": {"cell": "A3", "low": 0, "high": 1}}
    run = simulated(checked(cells, {"both": "C1"}, inputs), trials=2_000)
    assert list(run.inputs) == ["friction"]
    assert run.checks[0].failed == 0
    assert run.checks[0].holds


def test_a_check_of_a_blank_assumption_cell_is_refused(checked):
    cells = {**CELLS, "A3": None, "C1": "=AND(A1<2,A3<0.6)"}
    inputs = {**INPUTS, "extra": {"cell": "A3", "low": 0, "high": 1}}
    with pytest.raises(DefinitionError, match=r"S!A3: The checks need 'extra'.*Type its base value into the cell"):
        checked(cells, {"both": "C1"}, inputs)


def test_what_the_checks_hold_is_said(checked):
    inputs = {**INPUTS, "extra": {"cell": "A3", "low": 0, "high": 1}, "idle": {"cell": "A2", "low": 0, "high": 1}}
    message = [str(notice) for notice in checked({**CELLS, "C1": "=A3<0.6"}, {"both": "C1"}, inputs).notices]
    assert "S!A3: No forecast or filter needs the assumption 'extra': the checks take its base value" in message
    assert "S!A2: No forecast or filter needs the assumption 'idle'" in message


@pytest.mark.parametrize(
    ("checks", "sentence"),
    [
        ({"a": "C1"}, "1 check holds at the base case and in the 300 accepted trials"),
        ({"a": "C1", "b": "C3"}, "2 checks hold at the base case and in the 300 accepted trials"),
        ({"a": "C2"}, "1 of 1 check fails; looked at at the base case and in the 300 accepted trials"),
    ],
)
def test_the_sentence_agrees_with_the_number_of_checks(checked, checks, sentence):
    cells = {**CELLS, "C1": "=A1<2", "C2": "=A1>2", "C3": "=A1>0"}
    assert checks_sentence(simulated(checked(cells, checks), trials=300).checks) == sentence


def test_it_is_said_that_not_all_accepted_trials_were_looked_at(checked):
    run = simulated(checked(CELLS, {"below": "C1"}), trials=40_000, keep_inputs=0)
    check = run.checks[0]
    assert check.looked_at == "the first 10,000 accepted trials"
    assert f"of the first 10,000 accepted trials ({100 * check.share.value:.2f} %) fail the check" in check.warnings[0]


def test_without_a_base_case_the_trials_are_looked_at_alone(checked):
    run = simulated(checked({**CELLS, "A1": None}, {"below": "C1"}), trials=2_000)
    check = run.checks[0]
    assert (check.base.content, check.holds) == (None, None)
    assert check.failed > 0


def test_enough_draws_are_kept_for_the_checks(checked):
    run = simulated(checked(CELLS, {"below": "C1"}), trials=40_000, keep_inputs=0)
    assert run.checks[0].trials >= LEAST_CHECKED
    few = simulated(checked(CELLS, {"below": "C1"}), trials=400, keep_inputs=0)
    assert few.checks[0].trials == few.accepted == 400


def test_a_check_that_cannot_be_computed_is_refused_with_its_cell(checked):
    with pytest.raises(FormulaError, match="S!C1"):
        checked({**CELLS, "C1": "=NOSUCH(A1)"}, {"below": "C1"})


def test_a_model_without_checks_has_none(book):
    run = simulated(book(CELLS, INPUTS, {"twice": "B1"}), trials=100)
    assert run.checks == ()
    assert base_checks(run.model) == ()


def test_a_draw_in_a_cell_that_only_a_check_needs_is_held_at_its_mean(tmp_path):
    import openpyxl
    from openpyxl.worksheet.table import Table

    book = openpyxl.Workbook()
    sheet = book.active
    for row in (['=RiskOutput("twice")+A2*2'], ["=RiskUniform(1,2)"], ["=RiskUniform(0,1)<0.7"], [], ["Name", "Cell"]):
        sheet.append(row)
    sheet.append(["low", "=A3"])
    sheet.add_table(Table(displayName="xlmc_checks", ref="A5:B6"))
    book.save(tmp_path / "calls.xlsx")
    run = simulated(load(tmp_path / "calls.xlsx"), trials=500)
    assert len(run.inputs) == 1
    assert run.checks[0].holds  # held at its mean, 0.5
    assert run.checks[0].failed == 0


def test_cells_of_checks_are_read_too(checked):
    model = checked(CELLS | {"C4": "=A2>A3"}, {"plausible": "C4"})
    assert {"S!A1", "S!A2", "S!A3", "S!B1", "S!C4"} == {str(cell) for cell in model.read}
    assert {str(cell) for cell in model.trees} == {"S!B1", "S!C4"}
    assert {str(cell) for cell in checked(CELLS, {}).read} == {"S!A1", "S!B1"}
