from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from types import SimpleNamespace

import pytest

from xlmc.excel.workbook import temporary_names
from xlmc.excel.workbook.temporary_names import (
    new_file_name,
    new_folder_name,
    owned,
    remove_abandoned_files,
    remove_abandoned_folders,
)
from xlmc.montecarlo.columns.column_store import ColumnStore


@pytest.fixture
def dead():
    """The number of a process that has ended."""
    child = subprocess.Popen([sys.executable, "-c", ""])
    child.wait()
    return child.pid


def of(name, process):
    return name.replace(f"-{os.getpid()}-", f"-{process}-")


def test_what_a_dead_process_left_goes_and_nothing_else(tmp_path, dead):
    stray, living = of(new_file_name(), dead), of(new_file_name(), os.getppid())
    other = stray.replace(stray[6:14], "0" * 8)
    kept = [living, other, ".xlmc-mine.tmp", "case.xlsx", f"{stray}.xlsx", ".~lock.case.xlsx#"]
    for name in (stray, *kept):
        (tmp_path / name).write_bytes(b"")
    remove_abandoned_files(tmp_path)
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(kept)


def test_an_earlier_process_may_have_had_our_number(tmp_path):
    ours, earlier = new_file_name(), new_file_name()
    for name in (ours, earlier):
        (tmp_path / name).write_bytes(b"")
    with owned(ours):
        remove_abandoned_files(tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == [ours]


def test_a_file_nobody_wrote_to_for_a_day_goes_whoever_began_it(tmp_path):
    name = of(new_file_name(), os.getppid())
    old = tmp_path / name.replace(name[6:14], "0" * 8)
    old.write_bytes(b"")
    os.utime(old, (time.time() - 100_000,) * 2)
    remove_abandoned_files(tmp_path)
    assert not old.exists()


def test_no_folder_no_stray_files(tmp_path):
    remove_abandoned_files(tmp_path / "none")


def test_folders_of_dead_processes_go_with_the_next_run(tmp_path, monkeypatch, dead):
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    stray, living = of(new_folder_name(), dead), of(new_folder_name(), os.getppid())
    for name in (stray, living, "xlmc-notes"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "0.column").write_bytes(b"123")
    ColumnStore({})
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted([living, "xlmc-notes"])


def test_a_link_is_not_followed(tmp_path, monkeypatch, dead):
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    (tmp_path / "theirs").mkdir()
    (tmp_path / "theirs" / "file").write_bytes(b"")
    (tmp_path / of(new_folder_name(), dead)).symlink_to("theirs")
    remove_abandoned_folders()
    assert (tmp_path / "theirs" / "file").exists()


def test_a_process_of_another_person_lives(monkeypatch):
    def refuse(*_):
        raise PermissionError

    monkeypatch.setattr(os, "kill", refuse)
    assert temporary_names._lives(1)


def test_a_number_no_process_can_have_is_dead():
    assert not temporary_names._lives(10**30)


def kernel_of(handle, error=0, wait=0):
    """Windows' answers, in place of Windows."""
    closed = []
    return SimpleNamespace(
        handle=handle,
        closed=closed,
        OpenProcess=lambda access, inherit, process: handle,
        GetLastError=lambda: error,
        WaitForSingleObject=lambda handle, timeout: wait,
        CloseHandle=closed.append,
    )


@pytest.mark.parametrize(
    ("kernel", "lives"),
    [
        (kernel_of(7, wait=0x102), True),
        (kernel_of(7, wait=0), False),
        (kernel_of(0, error=87), False),
        (kernel_of(0, error=5), True),
    ],
)
def test_processes_on_windows_by_a_substitute(monkeypatch, kernel, lives):
    import ctypes

    monkeypatch.setattr(ctypes, "windll", SimpleNamespace(kernel32=kernel), raising=False)
    assert temporary_names._lives_on_windows(123) is lives
    assert kernel.closed == ([7] if kernel.handle else [])
