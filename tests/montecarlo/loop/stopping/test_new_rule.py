"""A made-up stop rule, added as `montecarlo/definitions/stopping.py` says: it runs, is shown, recorded and repeated."""

from __future__ import annotations

import importlib
import sys
from contextlib import closing
from dataclasses import fields

import numpy as np
import openpyxl
import pytest
from click.testing import CliRunner
from described import undescribed
from fewer_sheets import SHORT, keep_sheets
from simulated import simulated

import xlmc
import xlmc.cli
from xlmc.analysis.results.record import make_record
from xlmc.analysis.results.saved import open_run
from xlmc.api import Simulation
from xlmc.errors import DefinitionError, SimulationError
from xlmc.montecarlo.definitions.stopping import GOALS, MOST_TRIALS, Option, WholeGoal
from xlmc.montecarlo.loop.stopping import RULES
from xlmc.montecarlo.model.loading import load
from xlmc.outputs.replay import replay


class RejectedTrials(WholeGoal):
    """So many trials that a filter rejected."""

    __slots__ = ()
    key = "rejected"
    noun = things = "rejected trials"
    hint = "Give 1 or more"
    options = (
        Option(
            name="until_rejected",
            setting="Until rejected",
            metavar="N",
            help="Run until N trials are rejected.",
            takes=(1, MOST_TRIALS),
        ),
    )
    labels = (("until_rejected", "Until so many are rejected"),)


class UntilRejected:
    """The run ends with the trial that is the last of them."""

    key = RejectedTrials.key

    def __init__(self, asked):
        self._wanted, self._seen = asked.number, 0

    @property
    def goal(self):
        return f"{self._wanted:,} trials were rejected"

    @property
    def share(self):
        return min(1.0, self._seen / self._wanted)

    def counting(self, block, start):
        rejected = np.setdiff1d(np.arange(start, start + block.trials), block.accepted)
        missing = self._wanted - self._seen
        return block.trials if rejected.size < missing else int(rejected[missing - 1]) - start + 1

    def reached(self, block, columns):
        self._seen += block.trials - block.accepted.size
        return self._seen >= self._wanted


@pytest.fixture(autouse=True)
def doors(monkeypatch):
    """The two tables of which the docstring of `xlmc.montecarlo.definitions.stopping` speaks."""
    monkeypatch.setitem(GOALS, "rejected", RejectedTrials)
    monkeypatch.setitem(RULES, "rejected", UntilRejected)
    keep_sheets(monkeypatch, *SHORT)


@pytest.fixture
def commands(doors):
    """The command line, as it is made when the program starts."""
    known = {name: module for name, module in sys.modules.items() if f"{name}.".startswith("xlmc.cli.")}
    for name in known:
        del sys.modules[name]
    yield importlib.import_module("xlmc.cli").xlmc
    for name in [name for name in sys.modules if f"{name}.".startswith("xlmc.cli.")]:
        del sys.modules[name]
    sys.modules.update(known)
    xlmc.cli = known["xlmc.cli"]


@pytest.fixture
def model(small_book):
    """About a third of the trials are rejected."""
    return load(small_book)


@pytest.mark.parametrize("engine", ["numpy", "jit"])
def test_it_runs_is_recorded_and_repeated(model, tmp_path, engine):
    if engine == "jit":
        pytest.importorskip("llvmlite")
    run = simulated(model, until_rejected=100, engine=engine)
    assert run.trials - run.accepted == run.tally.rejected[0] == 100
    assert run.trials - 1 not in run.trial_index
    assert (run.stopped.by, run.stopped.sentence) == ("rejected", "100 trials were rejected")
    plain = simulated(model, run.trials, engine=engine)
    assert plain.trial_index.tolist() == run.trial_index.tolist()
    record = make_record(run)
    assert record["end.by"] == "rejected"
    assert record["end.goal"] == record["end.in_words"] == "100 trials were rejected"
    assert record["settings.until_rejected"] == 100
    kept = [Simulation(run).keep(tmp_path / "a.xlmcrun")]
    again = open_run(kept[0])
    assert (again.settings, again.stopped) == (run.settings, run.stopped)
    if engine == "numpy":
        kept.append(tmp_path / "a-results.xlsx")
        Simulation(run).save(kept[1])
    for path in kept:
        repeated = replay(path)
        assert repeated.to_the_last_bit, (repeated.changes, repeated.numbers)
        assert repeated.record["counts.trials"] == run.trials


def test_it_may_not_be_reached(model):
    run = simulated(model, 50, until_rejected=100)
    assert run.trials == 50
    assert run.stopped.sentence == "the limit of 50 trials was reached before 100 trials were rejected"
    assert run.stopped.sentence in run.warnings


@pytest.mark.parametrize(
    ("asked", "message"),
    [
        ({"until_rejected": 0}, "0 rejected trials were asked for"),
        ({"until_rejected": 1.5}, "1.5 rejected trials were asked for"),
        ({"until_rejected": 5, "precision": "1%"}, "A precision and rejected trials were both asked for"),
        ({"until_rejected": 5, "forecasts": "area"}, "orecasts are named, and no precision or stable digits"),
        ({"until_rejected": 5, "sampling": "lhs"}, "A run with lhs sampling cannot end before"),
    ],
)
def test_what_cannot_be_meant(model, asked, message):
    with pytest.raises(SimulationError, match=message):
        simulated(model, **asked)


def book_with(small_book, path, setting, value):
    """The small book, with another row in place of its number of trials."""
    result = openpyxl.load_workbook(small_book)
    result["Wanted"]["A9"], result["Wanted"]["B9"] = setting, value
    result.save(path)
    return path


def test_the_command_line_and_the_settings_ask_for_it(commands, small_book, tmp_path):
    row = book_with(small_book, tmp_path / "row.xlsx", "Until rejected", "1e2")
    typed = [
        ["simulate", str(small_book), "--until-rejected", "100", "-o", str(tmp_path / "a-results.xlsx")],
        ["simulate", str(row), "-o", str(tmp_path / "b-results.xlsx")],
    ]
    for arguments in typed:
        done = CliRunner().invoke(commands, arguments)
        assert "Ended when 100 trials were rejected." in done.output, (done.output, done.exception)
    for name in ("a-results.xlsx", "b-results.xlsx"):
        with closing(openpyxl.load_workbook(tmp_path / name, read_only=True)) as result:
            texts = [value for cells in result["Results"].iter_rows(values_only=True) for value in cells]
        assert "The run ended when 100 trials were rejected." in texts
    done = CliRunner().invoke(commands, ["replay", str(tmp_path / "b-results.xlsx")])
    assert done.exit_code == 0, done.output
    assert "--until-rejected N" in CliRunner().invoke(commands, ["simulate", "--help"]).output
    refused = CliRunner().invoke(commands, ["simulate", str(small_book), "--until-rejected", "0"])
    assert "0 is too small. Type 1 or more." in refused.output


def test_a_wrong_row_is_told_with_its_cell(small_book, tmp_path):
    row = book_with(small_book, tmp_path / "row.xlsx", "Until rejected", 0)
    with pytest.raises(DefinitionError, match=r"Wanted!B9: Until rejected must be a whole number from 1"):
        load(row)


def test_the_documents_lack_it_by_name():
    lacking = [line for line in undescribed() if "until" in line.casefold() and "rejected" in line]
    assert lacking == ["docs/command-line.md: --until-rejected", "docs/workbooks.md: Until rejected"]


def test_every_goal_has_a_rule_and_every_rule_a_goal(monkeypatch):
    def unmatched():
        return sorted(GOALS.keys() ^ RULES.keys())

    assert unmatched() == []
    monkeypatch.delitem(RULES, "rejected")
    assert unmatched() == ["rejected"]


@pytest.mark.parametrize("key", sorted({*GOALS, *RULES}))
def test_a_row_is_whole(key):
    goal, rule = GOALS[key], RULES[key]
    assert goal.key == rule.key == key
    assert len(goal.labels) == len(fields(goal)), key
    assert goal.options[0].name == goal.labels[0][0], key
