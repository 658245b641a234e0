from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import contest
import processes
import pytest
import rates
from contest import CellPlace, Task
from hypothesis import given
from hypothesis import strategies as st
from one_contestant import _real

from xlmc.excel.address import Cell


class Clock:
    """A run that costs `fixed` seconds and `each` a trial, on a clock of its own."""

    def __init__(self, fixed, each):
        self.now, self.fixed, self.each, self.runs = 0.0, fixed, each, []

    def __call__(self):
        return self.now

    def run(self, trials):
        self.runs.append(trials)
        self.now += self.fixed + self.each * trials


@given(st.integers(1, 40_000), st.floats(1e-9, 1e-2), st.floats(0.01, 3))
def test_measured_finds_the_rate(fewest, each, seconds):
    clock = Clock(0.0, each)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(contest, "perf_counter", clock)
        rate, trials = contest.measured(clock.run, fewest, seconds)
    assert rate == pytest.approx(1 / each, rel=1e-6)
    assert all(count % fewest == 0 for count in clock.runs)
    assert trials == clock.runs[-1]
    assert trials == fewest or trials * each < 2 * seconds


@pytest.mark.parametrize(("each", "runs"), [(1e-3, contest.REPEATS), (10.0, 1)])
def test_a_slow_contestant_runs_once(each, runs, monkeypatch):
    clock = Clock(0.0, each)
    monkeypatch.setattr(contest, "perf_counter", clock)
    contest.measured(clock.run, 1_000 if each < 1 else 1, 1.0)
    assert len(clock.runs) == runs


@given(st.integers(1, 1_048_576), st.integers(1, 16_384))
def test_places_print_as_cells(row, column):
    assert str(CellPlace("Model", row, column)) == str(Cell("Model", row, column))


TASK = Task("skid", "", [], [CellPlace("A", 1, 1), CellPlace("A", 2, 27)], [], [], 0.0)


def test_forecasts_that_differ_are_told_with_their_cell():
    truth = [[1.0, 2.0], [3.0, 0.0]]
    assert rates.differing(TASK, truth, truth) == []
    assert rates.differing(TASK, [[1.0 + 1e-10, 2.0]], truth) == []
    (message,) = rates.differing(TASK, [[1.0, 2.0], [3.0, 1e-12]], truth)
    assert message.startswith("A!AA2 in check trial 2")
    assert len(rates.differing(TASK, [[None, 2.1]], truth)) == 2


@pytest.mark.parametrize("value", [True, "3", None, float("nan"), float("inf")])
def test_only_real_numbers_are_answers(value):
    assert _real(value) is None


def test_numbers_are_answers():
    assert (_real(3), _real(2.5)) == (3.0, 2.5)


SCRIPT = """
import json, os, sys
given = json.loads(sys.stdin.readline())
if given["task"] == "fail":
    sys.exit("there is no such book")
print("some words")
print(json.dumps({"given": given, "threads": os.environ["OMP_NUM_THREADS"], "paths": sys.path}))
"""


def test_a_script_answers_in_a_process_of_its_own(tmp_path, monkeypatch):
    folder = tmp_path / "scripts"
    folder.mkdir()
    (folder / "say.py").write_text(SCRIPT, encoding="utf-8")
    monkeypatch.setattr(processes, "HERE", folder)
    answer = processes.answer_of(Path(sys.executable), "say.py", {"task": "skid"}, 60)
    assert answer["given"] == {"task": "skid"}
    assert answer["threads"] == "1"
    assert str(tmp_path) in answer["paths"]
    assert processes.answer_of(Path(sys.executable), "say.py", {"task": "fail"}, 60) == "failed: there is no such book"
    assert processes.answer_of(Path(sys.executable), "say.py", {"task": "skid"}, 1e-3) == "no answer within 0 s"


def test_scripts_find_what_they_import(tmp_path):
    """Where nothing but their own folder and the project's is on the path."""
    folder = Path(rates.__file__).parent
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(folder), str(folder.parent)])}
    scripts = "import one_contestant, one_growth, one_scaling, conformance"
    command = [sys.executable, "-W", "ignore", "-c", scripts]
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")


@pytest.mark.parametrize("script", ["one_contestant.py", "one_growth.py", "one_scaling.py"])
def test_a_script_that_is_started_does_its_work(script):
    source = Path(rates.__file__).with_name(script).read_text(encoding="utf-8")
    assert source.endswith('if __name__ == "__main__":\n    main()\n')
