"""Kills and full disks while files are written: the old file or the new one is whole, and nothing stray is left.

`python benchmarks/faults.py --kills 300 --disks 100` kills writers of every kind of output (`kill -9`), half of them
at random moments and half at a random call to the file system, and lets disks fill up at random bytes: a small tmpfs
where this is run by root, else a limit on the size of files. Exit code 1 where a file was broken or something stray was
left.
"""

from __future__ import annotations

import os

for _library in ("OPENBLAS", "OMP", "MKL"):  # a process with threads is not to be forked
    os.environ.setdefault(f"{_library}_NUM_THREADS", "1")

import argparse
import random
import resource
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import NoReturn
from unittest import mock

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

import numpy as np

import xlmc
from xlmc.api import Simulation
from xlmc.cli.new import templates
from xlmc.errors import XlmcError
from xlmc.excel.workbook.writer import write_workbook
from xlmc.montecarlo.columns import column_store

TOLD = 7
"""Exit code of a child that was told of a full disk in words."""
COLUMNS = "columns"
ENDINGS = {
    "workbook": "xlsx",
    "page": "html",
    "JSON": "json",
    "saved run": "xlmcrun",
    "CSV": "csv",
    "Parquet": "parquet",
    "template": "xlsx",
}
KINDS = (*ENDINGS, COLUMNS)
FULL = ("the disk is full", "no space left on the disk", "larger than may be written here", "File too large")


@dataclass
class CampaignResult:
    """What came of a campaign: how often each end was met, and what was broken."""

    ends: Counter[str] = field(default_factory=Counter)
    broken: list[str] = field(default_factory=list)


class Writers:
    """Two runs of one workbook, and what writes them: their files differ.

    Args:
        trials: of each run.
        book: name of an example.
    """

    def __init__(self, trials: int, book: str = "intersection") -> None:
        model = xlmc.load(ROOT / "examples" / f"{book}.xlsx")
        self._runs = [model.simulate(trials, seed) for seed in (1, 2)]
        self._templates = [next(iter(entry.editions.values())).read_bytes() for entry in templates().values()][:2]
        self._contents: dict[str, list[bytes]] = {}

    def write(self, kind: str, which: int, path: Path) -> None:
        """Write the first or the second run."""
        run = self._runs[which]
        if kind == "template":
            write_workbook(path, self._templates[which])
        else:
            self._writer(run, kind)(path, overwrite=True)

    @staticmethod
    def _writer(run: Simulation, kind: str) -> Callable[..., Path]:
        return {
            "workbook": run.save,
            "page": run.save_page,
            "JSON": run.save_json,
            "saved run": run.keep,
            "CSV": run.extract,
            "Parquet": run.extract,
        }[kind]

    def contents(self, kind: str) -> list[bytes]:
        """What the files of both runs hold when they are whole."""
        if kind not in self._contents:
            with tempfile.TemporaryDirectory() as folder:
                path = Path(folder, f"out.{ENDINGS[kind]}")
                self._contents[kind] = [self._content(kind, which, path) for which in (0, 1)]
        return self._contents[kind]

    def _content(self, kind: str, which: int, path: Path) -> bytes:
        self.write(kind, which, path)
        return path.read_bytes()


def fill_columns(folder: Path, values: int) -> None:
    """Keep columns on disk, in this folder, as a long run does."""
    before, tempfile.tempdir = tempfile.tempdir, str(folder)
    try:
        with mock.patch.multiple(column_store, IN_MEMORY=0, WRITTEN=0):
            keeper = column_store.ColumnStore({"a": np.dtype(np.float64)})
            for _ in range(values // 1_000):
                keeper.add("a", np.ones(1_000))
                keeper.write_if_full()
            del keeper
    finally:
        tempfile.tempdir = before


def in_child(work: Callable[[], None]) -> int:
    """Run it in a forked process; the process's number."""
    child = os.fork()
    if not child:
        _end_with(work)
    return child


def _end_with(work: Callable[[], None]) -> NoReturn:
    code = 1
    try:
        work()
        code = 0
    except XlmcError as error:
        code = TOLD if any(words in str(error) for words in FULL) else 3
    finally:
        os._exit(code)


def kill_at_call(number: int, folder: Path) -> None:
    """Have this process killed at its n-th call to the file system that names something in the folder."""
    left = [number]

    def watch(event: str, arguments: tuple[object, ...]) -> None:
        if event in _CALLS and any(str(folder) in str(each) for each in arguments):
            left[0] -= 1
            if left[0] <= 0:
                os.kill(os.getpid(), signal.SIGKILL)

    sys.addaudithook(watch)


_CALLS = frozenset(
    {"open", "os.rename", "os.link", "os.remove", "os.chmod", "os.mkdir", "os.scandir", "shutil.copymode"}
)


def killed(writers: Writers, kind: str, at: random.Random, result: CampaignResult) -> None:
    """Kill a process that writes files of this kind one after the other; then look, and write once more."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        path = folder / f"out.{ENDINGS.get(kind, '')}"
        if kind != COLUMNS:
            writers.write(kind, 0, path)
        call = _call(at)
        child = in_child(lambda: _write_for_ever(writers, kind, path, call))
        if not call:
            time.sleep(at.uniform(0.0, 0.4))
            os.kill(child, signal.SIGKILL)
        os.waitpid(child, 0)
        strays = [left.name for left in folder.iterdir() if left != path]
        result.ends["something stray until the next run" if strays else "nothing stray"] += 1
        if kind != COLUMNS and path.read_bytes() not in writers.contents(kind):
            result.broken.append(f"{kind}: broken by a kill")
        _write_once(writers, kind, path)
        _check_strays(kind, path, result, "after a kill and the next run")


def _call(at: random.Random) -> int:
    """At which call to kill; 0 at a moment instead."""
    return at.choice([0, at.randint(1, 24)])


def _write_for_ever(writers: Writers, kind: str, path: Path, call: int) -> None:
    if call:
        kill_at_call(call, path.parent)
    while True:
        for which in (1, 0):
            if kind == COLUMNS:
                fill_columns(path.parent, 200_000)
            else:
                writers.write(kind, which, path)


def _write_once(writers: Writers, kind: str, path: Path) -> None:
    if kind == COLUMNS:
        fill_columns(path.parent, 1_000)
    else:
        writers.write(kind, 1, path)


def _check_strays(kind: str, path: Path, result: CampaignResult, when: str) -> None:
    result.broken.extend(f"{kind}: {left.name} left {when}" for left in path.parent.iterdir() if left != path)


@contextmanager
def small_disk(size: int) -> Iterator[Path | None]:
    """A folder on a disk of its own of so many bytes; None where none can be mounted."""
    with tempfile.TemporaryDirectory() as folder:
        mount = ["mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", folder]
        if os.geteuid() != 0 or subprocess.run(mount, capture_output=True, check=False).returncode != 0:
            yield None
            return
        try:
            yield Path(folder)
        finally:
            subprocess.run(["umount", folder], check=True)


def full_disk(writers: Writers, kind: str, at: random.Random, result: CampaignResult, disk: Path | None) -> None:
    """Write where there is room for a part only; the old file is whole afterwards, and the person was told."""
    size = 1 << 20 if kind == COLUMNS else max(map(len, writers.contents(kind)))
    room = at.randint(0, size + size // 3)
    with tempfile.TemporaryDirectory(dir=disk) as name:
        path = Path(name, f"out.{ENDINGS.get(kind, '')}")
        if kind != COLUMNS:
            writers.write(kind, 0, path)
        filler = None if disk is None else _fill(disk, room)
        limit = room if disk is None else None
        child = in_child(lambda: _write_limited(writers, kind, path, limit))
        code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
        if filler is not None:
            filler.unlink()
        _check_full(writers, kind, path, code, result)


def _write_limited(writers: Writers, kind: str, path: Path, limit: int | None) -> None:
    if limit is not None:
        resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
    if kind == COLUMNS:
        fill_columns(path.parent, 200_000)
    else:
        writers.write(kind, 1, path)


def _fill(disk: Path, room: int) -> Path:
    """A file that leaves so many bytes of the disk, in whole pages."""
    filler, state = disk / "filler", os.statvfs(disk)
    with filler.open("wb") as file:
        file.write(bytes(max(0, state.f_bavail * state.f_frsize - room)))
    return filler


def _check_full(writers: Writers, kind: str, path: Path, code: int, result: CampaignResult) -> None:
    result.ends[{TOLD: "told that it is full", 0: "there was room"}.get(code, f"exit code {code}")] += 1
    if code not in (0, TOLD):
        result.broken.append(f"{kind}: exit code {code} on a full disk")
    if kind != COLUMNS and path.read_bytes() != writers.contents(kind)[0 if code else 1]:
        result.broken.append(f"{kind}: broken on a full disk")
    _check_strays(kind, path, result, "on a full disk")


def campaign(writers: Writers, kills: int, disks: int, seed: int) -> tuple[CampaignResult, CampaignResult]:
    """So many kills and full disks, over all kinds of output in turn."""
    at, of_kills, of_disks = random.Random(seed), CampaignResult(), CampaignResult()
    for number in range(kills):
        killed(writers, KINDS[number % len(KINDS)], at, of_kills)
    with small_disk(16 << 20) as disk:
        for number in range(disks):
            full_disk(writers, KINDS[number % len(KINDS)], at, of_disks, disk)
    return of_kills, of_disks


def main() -> None:
    """Run a campaign and print what came of it."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--kills", type=int, default=30)
    parser.add_argument("--disks", type=int, default=20)
    parser.add_argument("--seed", type=int, default=999)
    asked = parser.parse_args()
    writers = Writers(20_000)
    results = campaign(writers, asked.kills, asked.disks, asked.seed)
    for what, result in zip(("kills", "full disks"), results, strict=True):
        print(f"{what}: {sum(result.ends.values())}; {dict(result.ends)}; broken: {result.broken or 'none'}")
    sys.exit(1 if any(answer.broken for answer in results) else 0)


if __name__ == "__main__":
    main()
