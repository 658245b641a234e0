from __future__ import annotations

import os
import re
import signal
import sys
import time
from contextlib import closing
from importlib import import_module

import openpyxl
import pytest

from xlmc.cli.progress_bar import errors_line, trials_line
from xlmc.montecarlo.loop.stopping import Progress
from xlmc.montecarlo.simulation import simulate
from xlmc.montecarlo.statistics import Estimate

pytestmark = pytest.mark.usefixtures("short_books")


@pytest.fixture
def book(plain_book):
    return plain_book


def record_of(path):
    with closing(openpyxl.load_workbook(path, read_only=True)) as book:
        sheet = next(sheet for sheet in book if sheet.title.startswith("Record"))
        rows = sheet.iter_rows(max_col=3, values_only=True)
        return {row[0]: row[2] for row in rows if len(row) > 2 and row[0]}


def texts_of_results(path):
    with closing(openpyxl.load_workbook(path, read_only=True)) as book:
        sheets = book.worksheets
        titles = [next(sheet.iter_rows(max_row=1, max_col=1, values_only=True), (None,)) for sheet in sheets]
        (sheet,) = (
            sheet for sheet, (title, *_) in zip(sheets, titles, strict=True) if title == "Results of the simulation"
        )
        return [value for row in sheet.iter_rows(values_only=True) for value in row if isinstance(value, str)]


@pytest.mark.parametrize(
    ("options", "ended"),
    [
        (("--until-accepted", 800), "Ended when 800 trials were accepted."),
        (
            ("--precision", "1%", "--precision-of", "mean", "--for", "Speed", "--confidence", 90),
            "Ended when mean of Speed was known to within 1 % (90 % confidence).",
        ),
        (("-n", 10**9, "--time-limit", "0.01s"), "Ended when the time limit of 0.01 s was reached."),
    ],
)
def test_what_ended_a_run_is_printed_and_recorded(xlmc, book, tmp_path, options, ended):
    outcome = xlmc("simulate", book, *options)
    assert outcome.code == 0
    assert ended in outcome.out
    results = tmp_path / "case-results.xlsx"
    assert f"The run ended when {ended.removeprefix('Ended when ')}" in texts_of_results(results)
    assert f"Ended when {record_of(results)['end.in_words']}." == ended


def test_a_plain_run_says_nothing_of_its_end(xlmc, book):
    assert "Ended" not in xlmc("simulate", book, "-n", 1000).out


@pytest.mark.parametrize(
    "options", [("--until-accepted", 10**6), ("--precision", 1e-9), ("--adaptive", 3)], ids=lambda options: options[0]
)
def test_a_goal_that_was_not_reached_is_exit_code_1_and_still_written(xlmc, book, tmp_path, options):
    outcome = xlmc("simulate", book, "-n", 5000, *options)
    assert outcome.code == 1
    assert "warning: the limit of 5,000 trials was reached before " in outcome.err
    assert (tmp_path / "case-results.xlsx").exists()


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--until-accepted", 1), "--until-accepted"),
        (("--precision", "much"), "'much' is not a precision"),
        (("--precision", 1, "--until-accepted", 9), "were both asked for"),
        (("--precision-of", "mean"), "No precision was given"),
        (("--precision", 1, "--for", "Ford"), "There is no forecast 'Ford'"),
        (("--adaptive", 0), "--adaptive"),
        (("--time-limit", "later"), "'later' is not a length of time"),
    ],
)
def test_options_that_cannot_be_meant(xlmc, book, tmp_path, options, message):
    outcome = xlmc("simulate", book, *options)
    assert outcome.code == 2
    assert message in outcome.err
    assert not (tmp_path / "case-results.xlsx").exists()


def test_the_command_in_the_record_repeats_the_run(xlmc, book, tmp_path):
    first = xlmc("simulate", book.name, "--until-accepted", 321)
    record = record_of(tmp_path / "case-results.xlsx")
    words = record["run.repeat"].split()
    assert words[:3] == ["xlmc", "simulate", "case.xlsx"]
    again = xlmc(*words[1:])
    assert again.out == first.out
    assert record_of(tmp_path / "case-results.xlsx")["run.fingerprint"] == record["run.fingerprint"]


@pytest.mark.filterwarnings("ignore:.*fork:DeprecationWarning")
@pytest.mark.skipif(os.name != "posix", reason="process groups are POSIX's")
def test_ctrl_c_keeps_what_was_accepted(xlmc, started, book, tmp_path, monkeypatch):
    """A terminal tells the whole process group of Ctrl-C.

    Of this process alone, and of threads, tests/montecarlo/loop/stopping/test_runs.py interrupts runs; of a local
    cluster, tests/montecarlo/loop/scheduling/test_cluster.py.
    """
    add = simulate._Gathered.add

    def announced(self, block):
        add(self, block)
        print("block", file=sys.stderr, flush=True)
        time.sleep(0.01)  # so that few more come before the signal, however busy the machine is

    monkeypatch.setattr(simulate._Gathered, "add", announced)
    running = started("simulate", book, "-n", 10**9, "--quiet", "-j", 2, "--scheduler", "processes")
    assert [running.err.readline() for _ in range(3)] == ["block\n"] * 3
    os.killpg(running.number, signal.SIGINT)
    outcome = running.ended()
    monkeypatch.setattr(simulate._Gathered, "add", add)
    err = outcome.err.replace("block\n", "")
    assert outcome.code == 130, err
    assert "Ended when it was interrupted." in outcome.out
    assert err.splitlines()[-1].startswith("xlmc: interrupted after ")
    assert "Traceback" not in err
    results = tmp_path / "case-results.xlsx"
    assert "Fewer trials than were asked for: it was interrupted" in texts_of_results(results)
    record = record_of(results)
    assert record["end.by"] == "interruption"
    trials, blocks = record["counts.trials"], record["end.blocks"]
    assert trials == blocks * record["sampling.block"]
    repeated = xlmc(*record["run.repeat"].split()[1:])
    assert repeated.code == 0
    assert record_of(results)["run.fingerprint"] == record["run.fingerprint"]


@pytest.mark.filterwarnings("ignore:.*fork:DeprecationWarning")
@pytest.mark.skipif(os.name != "posix", reason="process groups are POSIX's")
def test_ctrl_c_in_the_reference_of_methods_keeps_an_answer(started, book, tmp_path, monkeypatch):
    def endless(*given):
        print("reference", file=sys.stderr, flush=True)
        time.sleep(600)

    monkeypatch.setattr(import_module("xlmc.analysis.studies.methods.study"), "reference_of", endless)
    running = started("methods", book, "--quiet", "-o", "methods.json")
    assert running.err.readline() == "reference\n"
    os.killpg(running.number, signal.SIGINT)
    outcome = running.ended()
    assert outcome.code == 130, outcome.err
    assert "Traceback" not in outcome.err
    assert outcome.err.splitlines()[-1].endswith("; the output is what was known by then.")
    assert "Recommended: Monte Carlo" in outcome.out
    assert "the study was interrupted before it" in " ".join(outcome.out.split())
    assert "ended_early" in (tmp_path / "methods.json").read_text(encoding="utf-8")


STANDING = Progress(
    65_536, 1_150, 0.5, {"Delta-V": Estimate(12.0, 0.0125), "e": Estimate(1.0), "v": Estimate(3.0, 45.6)}
)


def test_the_progress_bar():
    assert trials_line(STANDING) == "65,536 trials, 1,150 accepted (1.75 %)"
    assert errors_line(STANDING) == "± Delta-V 0.013, v 46"
    assert errors_line(Progress(10, 0, 0.0, {"x": Estimate(float("nan"))})) == ""


def test_the_progress_bar_on_a_terminal(on_a_screen, book):
    outcome = on_a_screen("simulate", book, "-n", 300_000)
    assert outcome.code == 0
    assert re.search(r"trials, [\d,]+ accepted \((59\.\d|60|60\.\d) %\)", outcome.err)
    assert "± Speed 0.001" in outcome.err
