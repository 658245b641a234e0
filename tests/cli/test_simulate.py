from __future__ import annotations

import shutil
import subprocess
import sys
import zipfile
from dataclasses import replace

import openpyxl
import pytest
from fewer_sheets import keep_few_trials

from xlmc.engine.llvm import REPAYS_FROM
from xlmc.errors import SimulationError
from xlmc.montecarlo.simulation import simulate

pytestmark = pytest.mark.usefixtures("short_books")

EDITED = {
    "[Content_Types].xml",
    "docProps/app.xml",
    "xl/_rels/workbook.xml.rels",
    "xl/styles.xml",
    "xl/workbook.xml",
}


@pytest.fixture
def book(plain_book):
    return plain_book


@pytest.fixture
def case_book(case_study, tmp_path):
    return shutil.copy(case_study, tmp_path / "case.xlsx")


def parts(path):
    with zipfile.ZipFile(path) as package:
        return {name: package.read(name) for name in package.namelist()}


def test_prints_the_papers_table_and_writes_a_copy(xlmc, case_book, tmp_path):
    outcome = xlmc("simulate", case_book, "--trials", 20_000)
    assert outcome.code == 0
    for words in ("Chevrolet delta-V", "51 % range", "of 20,000 trials", "seed 999", "Restitution, tangential"):
        assert words in outcome.out
    assert "Results are in" in outcome.out.replace("\n", " ")
    before, after = parts(case_book), parts(tmp_path / "case-results.xlsx")
    assert {name for name, data in before.items() if after[name] != data} <= EDITED


def test_the_command_line_wins_over_the_settings_table(xlmc, book):
    assert "Accepted" in (default := xlmc("simulate", book, "-n", 5_000)).out
    assert xlmc("simulate", book, "-n", 5_000, "--seed", 1).out != default.out
    assert xlmc("simulate", book, "-n", 5_000, "--seed", 7).out == default.out


def test_threads_change_nothing(xlmc, book):
    """The blocks are four, as a block has 32,768 trials."""
    assert xlmc("simulate", book, "-n", 100_000, "-j", 2).out == xlmc("simulate", book, "-n", 100_000).out


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--workers", 2), "The number of workers can be set for a local cluster only"),
        (("--scheduler", "ray"), "There is no scheduler 'ray'"),
    ],
)
def test_workers_that_cannot_be_had(xlmc, book, options, message):
    outcome = xlmc("simulate", book, "-n", 100, *options)
    assert outcome.code == 2
    assert message in outcome.err


def test_a_full_disk_is_a_message_and_nothing_is_lost(xlmc, book, tmp_path, monkeypatch):
    results = tmp_path / "case-results.xlsx"
    xlmc("simulate", book, "-n", 5_000)
    before = results.read_bytes()
    monkeypatch.setattr("xlmc.montecarlo.columns.column_store.IN_MEMORY", 0)
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "none"))
    outcome = xlmc("simulate", book, "-n", 10_000)
    assert outcome.code == 2
    assert outcome.err.startswith("xlmc: temporary folder: The accepted trials cannot be kept there: No such file")
    assert "TMPDIR" in outcome.err
    assert results.read_bytes() == before


def test_a_run_on_disk_says_so_before_it_starts(xlmc, book, monkeypatch):
    monkeypatch.setattr("xlmc.montecarlo.columns.column_store.IN_MEMORY", 0)
    sentence = xlmc("simulate", book, "-n", 2_000).err
    assert sentence.startswith("This run keeps about ")
    assert "GB on disk in" in sentence
    assert xlmc("simulate", book, "-n", 1_000, "--quiet").err == ""


def test_a_run_that_the_disk_cannot_hold_is_refused(xlmc, book, tmp_path, monkeypatch):
    results = tmp_path / "case-results.xlsx"
    xlmc("simulate", book, "-n", 5_000)
    before = results.read_bytes()
    monkeypatch.setattr("xlmc.montecarlo.columns.column_store.IN_MEMORY", 0)
    monkeypatch.setattr("xlmc.montecarlo.loop.disk_needed.free_disk", lambda: (tmp_path, 1_000))
    outcome = xlmc("simulate", book, "-n", 10_000)
    assert outcome.code == 2
    assert "The run needs about" in outcome.err
    assert "TMPDIR" in outcome.err
    assert results.read_bytes() == before


def test_in_place_replaces_its_own_sheets_and_nothing_else(xlmc, whole_book, book, monkeypatch):
    keep_few_trials(monkeypatch)
    before = parts(book)
    assert xlmc("simulate", book, "--in-place").code == 0
    once = parts(book)
    assert xlmc("simulate", book, "--in-place").code == 0
    twice = parts(book)
    changed = [name for name, data in once.items() if twice.get(name) != data]
    assert set(once) == set(twice)
    assert [b"SHA-256" in twice[name] for name in changed] == [True]  # the record: it names the file that was read
    assert {name for name, data in before.items() if once[name] != data} <= EDITED


def test_in_place_and_output_exclude_each_other(xlmc, book):
    assert xlmc("simulate", book, "--in-place", "-o", "other.xlsx").code == 2


def test_refuses_a_workbook_that_excel_holds_open(xlmc, book, tmp_path):
    (tmp_path / "~$case.xlsx").write_bytes(b"")
    outcome = xlmc("simulate", book, "--in-place")
    assert outcome.code == 2
    assert "Excel holds the workbook open" in outcome.err


def test_no_accepted_trial_is_exit_code_1_and_still_written(xlmc, book, tmp_path):
    workbook = openpyxl.load_workbook(book)
    workbook["Wanted"]["C6"] = 2
    workbook.save(book)
    outcome = xlmc("simulate", book, "-n", 5_000)
    assert outcome.code == 1
    assert "no trial was accepted" in outcome.err
    assert (tmp_path / "case-results.xlsx").exists()


def test_one_trial(xlmc, book):
    assert xlmc("simulate", book, "-n", 1).code in (0, 1)


@pytest.mark.parametrize("option", [("--trials", "0"), ("--trials", "many"), ("--seed", "-1"), ("--jobs", "0")])
def test_options_out_of_range(xlmc, book, option):
    outcome = xlmc("simulate", book, *option)
    assert outcome.code == 2
    assert option[0] in outcome.err


def test_an_output_folder_that_is_not_there_loses_nothing(xlmc, book, tmp_path):
    outcome = xlmc("simulate", book, "-n", 1_000, "-o", tmp_path / "nowhere" / "out.xlsx")
    assert outcome.code == 2
    assert "nowhere" in outcome.err
    assert sorted(path.name for path in tmp_path.iterdir()) == ["case.xlsx"]


def test_the_reference_engine_gives_the_same_answer(xlmc, book):
    """The table prints 4 digits or so; both engines agree to 1e-12."""
    fast, slow = (
        xlmc("simulate", book, "-n", 60, "--seed", 39, "--engine", engine).out for engine in ("numpy", "formulas")
    )
    assert fast == slow


def test_help_imports_no_numerical_library_and_reads_no_workbook_modules():
    slow = ("numpy", "scipy", "pandas", "openpyxl", "rich", "formulas", "xlmc.excel.workbook.reader", "asyncio")
    program = (
        "import runpy, sys; sys.argv = ['xlmc', '--help']\n"
        "try: runpy.run_module('xlmc', run_name='__main__')\nexcept SystemExit: pass\n"
        f"print([m for m in {slow} if m in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", program], check=True, capture_output=True, text=True)
    assert done.stdout.splitlines()[-1] == "[]"


def test_without_llvmlite_the_engine_jit_says_what_to_install(xlmc, book, tmp_path, monkeypatch):
    monkeypatch.setattr("xlmc.engine.llvm.find_spec", lambda name: None)
    outcome = xlmc("simulate", book, "-n", 1_000, "--engine", "jit")
    assert outcome.code == 2
    assert 'pip install "llvmlite>=0.45"' in outcome.err
    assert not (tmp_path / "case-results.xlsx").exists()


@pytest.mark.parametrize(
    ("trials", "options", "installed", "hinted"),
    [
        (REPAYS_FROM, (), True, True),
        (REPAYS_FROM - 1, (), True, False),
        (REPAYS_FROM, (), False, False),
        (REPAYS_FROM, ("--engine", "formulas"), True, False),
        (REPAYS_FROM, ("--quiet",), True, False),
    ],
)
def test_a_long_run_is_told_of_the_engine_jit(xlmc, book, monkeypatch, trials, options, installed, hinted):
    def stopped(*arguments, **named):
        raise SimulationError("stopped by the test")

    monkeypatch.setattr("xlmc.montecarlo.simulation.simulate.run_model", stopped)
    monkeypatch.setattr("xlmc.engine.llvm.find_spec", lambda name: object() if installed else None)
    assert ("--engine jit" in xlmc("simulate", book, "-n", trials, *options).err) is hinted


@pytest.mark.parametrize(
    ("method", "words"),
    [
        ("mc", "Monte Carlo: independent trials; errors come from the spread of the trials"),
        ("lhs", "Latin hypercube: 16 independent replicates of 2,500 trials; errors come from the differences between"),
        ("lhs500", "Latin hypercube in blocks of 500: 80 independent replicates of 500 trials; errors come from"),
        ("sobol", "scrambled Sobol: 20 independent replicates of 2,048 trials, whole ones, for the 40,000 trials"),
    ],
)
def test_the_sampling_method_is_said(xlmc, book, method, words):
    outcome = xlmc("simulate", book, "-n", 40_000, "--sampling", method)
    assert outcome.code == 0
    assert words in " ".join(outcome.out.split())


def test_too_few_accepted_trials_in_a_replicate_are_exit_code_1(xlmc, book):
    outcome = xlmc("simulate", book, "-n", 200, "--sampling", "lhs")
    assert outcome.code == 1
    assert "trials were accepted in 16 replicates, fewer than 160" in " ".join(outcome.err.split())


def test_html_writes_the_page_beside_the_workbook(xlmc, book, tmp_path):
    outcome = xlmc("simulate", book, "-n", 5_000, "--html", "page.html")
    assert outcome.code == 0
    assert "The page is page.html" in outcome.out
    page = (tmp_path / "page.html").read_text("utf-8")
    assert page.startswith("<!doctype html>")
    assert "Speed" in page
    assert (tmp_path / "case-results.xlsx").exists()


@pytest.mark.parametrize(
    ("path", "why"), [("page.xlsx", "must end in .html"), ("none/page.html", "There is no folder")]
)
def test_a_page_that_cannot_be_written_is_refused_before_the_run(xlmc, book, tmp_path, path, why):
    outcome = xlmc("simulate", book, "-n", 5_000, "--html", path)
    assert outcome.code == 2
    assert why in outcome.err
    assert not (tmp_path / "case-results.xlsx").exists()


def test_the_engine_jit_prints_the_same_answers_and_keeps_its_code_unless_it_is_not_wanted(
    xlmc, book, tmp_path, monkeypatch
):
    pytest.importorskip("llvmlite")
    from xlmc.engine.llvm import code_cache
    from xlmc.engine.llvm.machine import machine

    monkeypatch.setattr(code_cache, "_caches", lambda: tmp_path)
    answer = xlmc("simulate", book, "-o", "r.xlsx")
    for option, there in ((["--no-kept-code"], False), ([], True)):
        monkeypatch.setenv("XLMC_KEEP_CODE", "1")
        machine.cache_clear()
        assert xlmc(*option, "simulate", book, "--engine", "jit", "-o", "r.xlsx", "--overwrite") == answer
        assert (tmp_path / "xlmc").exists() is there


def test_a_local_cluster_and_its_workers_are_asked_for(xlmc, book, monkeypatch):
    asked, run_model = [], simulate.run_model

    def recorded(model, options, **named):
        asked.append((options.scheduler, options.workers))
        return run_model(model, replace(options, scheduler=None, workers=None), **named)

    monkeypatch.setattr(simulate, "run_model", recorded)
    assert xlmc("simulate", book, "-n", 1_000, "--scheduler", "local", "--workers", 1).code == 0
    assert asked == [("local", 1)]
