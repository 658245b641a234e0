"""What the plugins of this folder do to a run of the tests: three small runs, of all these plugins at once."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import pytest
from cases import cases

PLUGINS = ["both_ends", "cases", "costliest", "not_tested", "process_costs", "tree_guard", "work_stealing"]
COSTS = """
import subprocess, sys, time

def work(seconds):
    end = time.process_time() + seconds
    while time.process_time() < end:
        pass

def test_works():
    work(0.08)

def test_waits():
    time.sleep(0.08)

def test_starts_a_process():
    subprocess.run([sys.executable, "-c", "import time\\nwhile time.process_time() < 0.15: pass"], check=True)
"""
SKIPPED = """
import pytest
from needed_programs import missing

@pytest.fixture(scope="session")
def browser(): pytest.skip(missing("chromium", "chromedriver"))

def test_in_a_browser(browser): pass
def test_also(browser): pass

@pytest.mark.skipif(bool(missing("soffice")), reason=missing("soffice"))
def test_printed(): pass
def test_plain(): pass
"""
PROCESSES = """
import gc, os, subprocess, sys

def test_modules_and_garbage():
    assert gc.isenabled()
    assert gc.get_freeze_count() > 1000
    assert gc.get_threshold()[0] > 10_000
    told = subprocess.run([sys.executable, "-c", "import sys; print(sys.dont_write_bytecode)"], capture_output=True)
    assert told.stdout.split() == [b"False"]

def test_threads():
    assert [os.environ.get(name) for name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS")] == ["1", "7"]
"""
WRITES = """
from pathlib import Path
def test_a(): Path("left-results.xlsx").write_text("")
"""
COLLECTED = """
import os, time
from pathlib import Path
(Path.cwd().parent / f"{time.monotonic_ns()} {os.environ['PYTEST_XDIST_WORKER']} {Path(__file__).name}").touch()
"""
NEIGHBOURS = """
import os, pytest

@pytest.fixture(scope="session")
def shared(): return os.getpid()

@pytest.mark.parametrize("n", range(40))
def test_a(n, shared, tmp_path_factory):
    (tmp_path_factory.getbasetemp().parent / f"{n:02}-{shared}").touch()
"""
CASES = """
import pytest
from cases import cases

@pytest.fixture(scope="session")
def limit():
    return 3

@cases("a", [1, 2, 3, 4], ids=["one", "two", "three", "four"])
@cases("b, c", [(0, 0), (1, 1)])
def test_sums(a, b, limit, c):
    assert b == c
    assert a + b <= limit

@cases(["word"], [("left",), pytest.param("right", id="the other")])
def test_words(word):
    if word == "right":
        pytest.fail("not right")
"""
BROWSER = "Chromium and Chromium's driver are not installed (apt-get install chromium; apt-get install chromium-driver)"


@dataclass(frozen=True)
class Run:
    """A run of tests in a folder: its exit code and its output."""

    folder: Path
    code: int
    shown: str


@pytest.fixture(scope="module")
def run(run_tests, tmp_path_factory):
    """`run(sources, *arguments)`: these tests with all plugins, where no program is installed."""

    def make(sources, *arguments, before=()):
        folder = tmp_path_factory.mktemp("runs")
        project = folder / "project"
        project.mkdir()
        for name in before:
            (project / name).touch()
        given = {f"test_{name}.py": source for name, source in sources.items()}
        environment = {"PYTHONDONTWRITEBYTECODE": "1", "OMP_NUM_THREADS": "7", "PATH": ""}
        given_arguments = f"--basetemp={folder / 'base'}", "--costs", str(folder / "costs.txt"), *arguments
        with pytest.MonkeyPatch.context() as patch:
            patch.delenv("OPENBLAS_NUM_THREADS", raising=False)
            return Run(folder, *run_tests(project, given, *given_arguments, plugins=PLUGINS, **environment))

    return make


@pytest.fixture(scope="module")
def shared(run):
    """All but those that fail, by two processes."""
    sources = {"costs": COSTS, "processes": PROCESSES, "skipped": SKIPPED}
    sources |= {"neighbours": COLLECTED + NEIGHBOURS, "writes": COLLECTED + WRITES}
    return run(sources, "-n", "2")


@pytest.fixture(scope="module")
def alone(run):
    """By one process, that calls a run of a tenth of a second a long one; some fail."""
    costs = COSTS + "\nimport costliest\ncostliest.LONG = 0.1\n"
    return run({"cases": CASES, "costs": costs, "processes": PROCESSES, "skipped": SKIPPED, "writes": WRITES})


@pytest.fixture(scope="module")
def quiet(run):
    """A few that pass, by one process, and a file that lies there."""
    sources = {"cases": CASES, "writes": WRITES}
    return run(sources, "--apart", "-k", "one or two or left and not test_a", before=["left-results.xlsx"])


def test_a_run_that_leaves_a_file_fails_and_names_it(shared, alone):
    assert "failed" not in shared.shown
    assert "47 passed, 3 skipped" in shared.shown
    assert shared.code == alone.code == 1
    assert shared.shown.count("appeared: left-results.xlsx") == 1
    assert alone.shown.count("appeared: left-results.xlsx") == 1


def test_a_run_that_leaves_nothing_passes(quiet):
    assert quiet.code == 0, quiet.shown
    assert "appeared" not in quiet.shown


def test_a_file_has_the_processor_time_of_each_test_and_of_what_it_starts(shared):
    assert "Processor time" not in shared.shown
    rows = [line.split("\t") for line in (shared.folder / "costs.txt").read_text("utf-8").splitlines()]
    found = {name.partition("::")[2]: float(cost) for cost, name in rows if name.startswith("test_costs.py")}
    assert list(found) == ["test_starts_a_process", "test_works", "test_waits"]
    assert found["test_starts_a_process"] >= 0.14
    assert found["test_works"] >= 0.07
    assert found["test_waits"] < 0.05
    assert sorted(rows, key=lambda row: -float(row[0])) == rows


def test_a_long_run_names_the_files(alone):
    said = alone.shown.partition("Processor time: ")[2]
    assert " s; most of it" in said, alone.shown
    assert " s  test_costs.py" in said


def test_the_summary_names_what_was_skipped_and_why(shared, alone):
    for run in (shared, alone):
        told = run.shown.partition("Not tested here")[2]
        assert f"test_skipped.py (2): {BROWSER}" in told
        assert "test_skipped.py (1): LibreOffice is not installed (apt-get install libreoffice-calc-nogui)" in told


def test_nothing_is_said_where_nothing_is_skipped(quiet):
    assert "Not tested here" not in quiet.shown


def test_modules_are_kept_garbage_is_collected_and_processes_that_share_the_tests_have_one_thread(shared, alone):
    """One thread each, unless told otherwise, and where the tests are shared only: alone, the test of threads fails."""
    assert "test_processes.py" not in shared.shown
    assert alone.shown.count("FAILED test_processes.py") == 1
    assert "FAILED test_processes.py::test_threads" in alone.shown


def test_each_of_two_workers_has_neighbouring_tests(shared):
    who = [path.name.partition("-")[2] for path in sorted((shared.folder / "base").glob("??-*"))]
    assert len(who) == 40
    assert sum(a != b for a, b in pairwise(who)) <= 10


def test_the_second_worker_collects_from_the_end(shared):
    seen = [path.name.split()[1:] for path in sorted(shared.folder.glob("* test_*.py"))]
    files = ["test_neighbours.py", "test_writes.py"]
    assert [name for worker, name in seen if worker == "gw0"] == files
    assert [name for worker, name in seen if worker == "gw1"] == files[::-1]


def test_every_case_that_fails_is_named(alone):
    assert alone.shown.count("FAILED test_cases.py") == 2
    assert "case three: a=3" in alone.shown
    assert "case four: a=4" in alone.shown
    assert "case two" not in alone.shown
    assert "case 1: b=1, c=1" in alone.shown
    assert "case 1: word='right'" in alone.shown
    assert "case 0: word" not in alone.shown


def test_a_case_cannot_be_skipped(monkeypatch):
    monkeypatch.setattr(cases, "apart", False)
    with pytest.raises(TypeError, match="leave it out of the cases"):
        cases("a", [1, 2])(lambda a: pytest.skip("not here"))()


def test_apart_each_case_is_a_test(quiet):
    assert "5 passed" in quiet.shown
