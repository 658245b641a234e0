"""A child process that runs inputs one after the other, under limits of memory and, by its parent, of time."""

from __future__ import annotations

import contextlib
import gc
import os
import resource
import shutil
import sys
import tempfile
import time
import warnings
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Final

from fuzzing.inputs import Kind, Reached, generator
from fuzzing.verdict import Finding, of_error
from xlmc.excel.workbook.temporary_names import new_folder_name, owned, remove_abandoned_folders

__all__ = ["MEMORY", "Outcome", "judged", "serve"]

MEMORY: Final = 1 << 30
"""What a child may take beside what it has when it starts, in bytes."""


@dataclass(frozen=True, slots=True)
class Outcome:
    """What became of an input.

    Attributes:
        reached: None where there is a finding.
        seconds: of processor time.
        memory: the most that the child held more than before, in bytes.
        said, name, data: of the input, where there is a finding.
    """

    number: int
    reached: Reached | None
    seconds: float
    memory: int = 0
    finding: Finding | None = None
    said: str = ""
    name: str = ""
    data: bytes = b""


def serve(kind: str, how: Kind, seed: int, numbers: Iterable[int], parent: Connection) -> None:
    """Run the inputs of these numbers, and tell the parent each number before and its outcome after."""
    sys.stdout = sys.stderr = open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115 - as long as the process lives
    os.dup2(sys.stderr.fileno(), 2)  # where libraries write that are not in Python
    resource.setrlimit(resource.RLIMIT_AS, (_held("VmSize") + MEMORY,) * 2)
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    gc.freeze()  # no garbage is looked for in what the parent holds, which would copy all of it
    with _folder_of_its_own() as folder:
        os.chdir(folder)
        for number in numbers:
            parent.send(number)
            parent.send(judged(kind, how, seed, number, folder))
    parent.send(None)


@contextlib.contextmanager
def _folder_of_its_own() -> Iterator[Path]:
    """A temporary folder; those of children that were killed are removed first, known by the process in their names."""
    remove_abandoned_folders()
    name = new_folder_name()
    folder = Path(tempfile.gettempdir()) / name
    with owned(name):
        folder.mkdir()
        try:
            yield folder
        finally:
            shutil.rmtree(folder, ignore_errors=True)


def judged(kind: str, how: Kind, seed: int, number: int, folder: Path) -> Outcome:
    """One input, run and judged."""
    given = how.make(generator(kind, seed, number))
    before, started = _forget_the_most(), time.process_time()
    reached, finding = None, None
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            reached = how.run(given, folder)
    except (Exception, SystemExit) as error:
        finding = of_error(error)
        reached = Reached.REFUSED if finding is None else None
    seconds, memory = time.process_time() - started, max(0, _held("VmHWM") - before)
    if finding is None:
        return Outcome(number, reached, seconds, memory)
    with contextlib.suppress(MemoryError):
        gc.collect()
    return Outcome(number, None, seconds, memory, finding, given.said, given.name, given.data)


def _forget_the_most() -> int:
    """Start anew to look for the largest memory; what is held now."""
    with contextlib.suppress(OSError):
        Path("/proc/self/clear_refs").write_text("5", encoding="utf-8")
    return _held("VmRSS")


def _held(what: str) -> int:
    """A line of `/proc/self/status`, in bytes."""
    with open("/proc/self/status", encoding="utf-8") as status:
        line = next(line for line in status if line.startswith(what))
    return int(line.split()[1]) << 10
