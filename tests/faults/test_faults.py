"""Kills, full disks, two writers and SIGTERM: `benchmarks/faults.py` does many more of them."""

from __future__ import annotations

import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from faults import (
    COLUMNS,
    KINDS,
    CampaignResult,
    _check_full,
    _check_strays,
    _write_limited,
    _write_once,
    in_child,
    kill_at_call,
)
from faults import full_disk as fill_up
from simulated import simulated

import xlmc.excel.workbook.writer as writer
from xlmc.excel.workbook.target import Target
from xlmc.montecarlo.model.loading import load

ROOT = Path(__file__).resolve().parents[2]
pytestmark = pytest.mark.filterwarnings("ignore:.*fork:DeprecationWarning")
ENDING = {"workbook": ".xlsx", "page": ".html", "JSON": ".json", "saved run": ".xlmcrun", "CSV": ".csv"}


@pytest.mark.parametrize("call", [1, 2, 3, 4, 5, 6, 8])
def test_a_writer_killed_at_any_call_leaves_a_whole_file(tmp_path, call):
    path = tmp_path / "case.html"
    path.write_bytes(b"old")

    def work():
        kill_at_call(call, tmp_path)
        for _ in range(10):
            writer.write_workbook(path, b"new" * 100_000)

    status = os.waitpid(in_child(work), 0)[1]
    assert os.WTERMSIG(status) == signal.SIGKILL
    assert path.read_bytes() in (b"old", b"new" * 100_000)
    writer.write_workbook(path, b"newer")
    assert [(left.name, left.read_bytes()) for left in tmp_path.iterdir()] == [("case.html", b"newer")]


@pytest.mark.parametrize("kind", KINDS)
def test_a_kill_while_a_kind_of_output_is_written_breaks_nothing(writers, kind, tmp_path):
    path, result = tmp_path / f"out{ENDING.get(kind, '.xlsx')}", CampaignResult()
    if kind in ("Parquet", COLUMNS):
        path = tmp_path / ("out.parquet" if kind == "Parquet" else "out.")
    if kind != COLUMNS:
        path.write_bytes(writers.contents(kind)[0])

    def work():
        kill_at_call(4, tmp_path)
        for _ in range(4):
            _write_once(writers, kind, path)

    assert os.WIFSIGNALED(os.waitpid(in_child(work), 0)[1])
    if kind != COLUMNS:
        assert path.read_bytes() in writers.contents(kind)
    _write_once(writers, kind, path)
    _check_strays(kind, path, result, "after a kill")
    assert result.broken == []


@pytest.mark.parametrize("kind", KINDS)
def test_a_full_disk_breaks_nothing_and_is_told(writers, kind, tmp_path):
    """By a limit on the size of files, which anybody can set."""
    path, result = tmp_path / f"out{ENDING.get(kind, '.xlsx')}", CampaignResult()
    if kind in ("Parquet", COLUMNS):
        path = tmp_path / ("out.parquet" if kind == "Parquet" else "out.")
    if kind != COLUMNS:
        path.write_bytes(writers.contents(kind)[0])
    child = in_child(lambda: _write_limited(writers, kind, path, 1_500))
    _check_full(writers, kind, path, os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), result)
    assert result.broken == []
    assert result.ends == {"told that it is full": 1}


def test_the_campaign_of_full_disks_runs_where_none_can_be_mounted(writers):
    result = CampaignResult()
    fill_up(writers, "CSV", random.Random(1), result, None)
    assert result.broken == []


def test_two_writers_of_one_file_do_not_disturb_each_other(tmp_path):
    path = tmp_path / "case.html"
    path.write_bytes(b"0" * 200_000)

    def work(byte):
        for _ in range(30):
            writer.write_workbook(path, byte * 200_000)

    children = [in_child(lambda byte=byte: work(byte)) for byte in (b"1", b"2")]
    while children:
        content = path.read_bytes()
        assert len(content) == 200_000
        assert len(set(content)) == 1
        for child in [*children]:
            done, status = os.waitpid(child, os.WNOHANG)
            if done:
                children.remove(done)
                assert status == 0
    assert [left.name for left in tmp_path.iterdir()] == ["case.html"]


def test_two_writers_that_both_begin_a_new_file(tmp_path):
    path = tmp_path / "case.html"
    writer.write_workbook(path, b"theirs")
    target = Target(path, "case.xlsx")
    with pytest.raises(writer.TakenError):
        writer.write_workbook(path, b"ours", target.check)
    assert path.read_bytes() == b"theirs"


SCRIPT = """
import sys
from xlmc.montecarlo.columns import column_store
column_store.IN_MEMORY = column_store.WRITTEN = 0
from xlmc.cli import main
sys.argv = ["xlmc", *sys.argv[1:]]
main()
"""


def typed(book, tmp_path):
    """A run without end, after the name of the program."""
    return ["simulate", str(book), "-n", "1000000000", "-o", str(tmp_path / "out.xlsx"), "--quiet"]


def began(folder, is_over):
    """Wait until the run keeps columns on disk, at most a minute."""
    end = time.monotonic() + 60
    while not (result := any(folder.glob("xlmc-*"))) and not is_over() and time.monotonic() < end:
        time.sleep(0.005)
    return result


@pytest.fixture
def temporary(tmp_path):
    folder = tmp_path / "temporary"
    folder.mkdir()
    return folder


def started(book, tmp_path, temporary, options=()):
    """Start a run without end, and wait until it keeps columns on disk."""
    command = [sys.executable, "-P", "-c", SCRIPT, *typed(book, tmp_path), *options]
    environment = os.environ | {"TMPDIR": str(temporary)}
    process = subprocess.Popen(command, cwd=ROOT, stderr=subprocess.PIPE, text=True, env=environment)
    assert began(temporary, lambda: process.poll() is not None)
    return process


@pytest.mark.parametrize(
    ("number", "name", "options"),
    [
        (signal.SIGHUP, "SIGHUP", ["-j", "2", "--scheduler", "processes"]),
        (signal.SIGTERM, "SIGTERM", []),
    ],
)
def test_a_program_that_is_asked_to_end_clears_away(small_book, tmp_path, temporary, number, name, options):
    process = started(small_book, tmp_path, temporary, options)
    process.send_signal(number)
    message = process.communicate(timeout=120)[1]
    assert process.returncode == 128 + number
    assert message == f"xlmc: ended by {name}; no file is left half-written.\n"
    assert list(temporary.iterdir()) == []
    assert [left.name for left in tmp_path.iterdir()] == ["temporary"]


def test_the_next_run_removes_the_columns_of_a_killed_one(small_book, tmp_path, temporary, monkeypatch):
    process = started(small_book, tmp_path, temporary)
    process.kill()
    process.communicate(timeout=120)
    assert list(temporary.iterdir()) != []
    monkeypatch.setattr("tempfile.tempdir", str(temporary))
    simulated(load(small_book), 100)
    assert list(temporary.iterdir()) == []
