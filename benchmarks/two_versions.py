"""What commands cost in this version beside another: `python benchmarks/two_versions.py v0.11.2`.

The other version is a revision, for which a worktree is made and removed, or the path of a tree (`--new` gives another
tree for this one). For each workbook `xlmc check` and `xlmc simulate` run in both in turn, in processes of their own,
with the same Python and packages. Medians of the processor time, user and system, and of its ratios are printed.
Python's bytecode of both versions and their compiled programs are kept from a first run that does not count.

The first line says what `xlmc --version` takes beside a Python that imports click.
"""

from __future__ import annotations

import argparse
import contextlib
import os
import resource
import statistics
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Final

import machine

__all__ = ["main", "processor_time", "ratio", "tree_of"]

ROOT: Final = Path(__file__).resolve().parents[1]
CASE_STUDY: Final = ROOT / "examples" / "intersection.xlsx"
PAIRS: Final = 9

_VERSION: Final = ("-m", "xlmc", "--version")
_BARE: Final = ("-c", "import click")


@contextlib.contextmanager
def tree_of(given: str, folder: Path) -> Iterator[Path]:
    """Give the folder of a version: the path itself, or a temporary worktree of a revision."""
    if (Path(given) / "xlmc").is_dir():
        yield Path(given).resolve()
        return
    tree = folder / "other-version"
    git = ("git", "-C", str(ROOT), "worktree")
    subprocess.run([*git, "add", "--detach", "--quiet", str(tree), given], check=True)
    try:
        yield tree
    finally:
        subprocess.run([*git, "remove", "--force", str(tree)], check=True)


def processor_time(tree: Path, arguments: Sequence[str], folder: Path) -> float:
    """Run Python in a folder with the package of a tree; seconds of user and system together.

    Raises:
        RuntimeError: a command refused its input, or failed; with its last words.
    """
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    environment |= {
        "PYTHONPATH": str(tree),
        "PYTHONPYCACHEPREFIX": str(folder / "bytecode"),
        "XDG_CACHE_HOME": str(folder / "programs"),
    }
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    command = [sys.executable, *arguments]
    done = subprocess.run(command, env=environment, cwd=folder, capture_output=True, text=True, check=False)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode not in (0, 1):  # 1: the run finished, and warns of its answer
        raise RuntimeError(f"{' '.join(arguments)} in {tree}: {done.stderr[-2000:]}")
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def ratio(
    new: tuple[Path, Sequence[str]], old: tuple[Path, Sequence[str]], pairs: int, folder: Path
) -> tuple[float, float, float]:
    """Measure two commands in turn: the medians of both, and the median of the ratios of each pair."""
    for each in (new, old):
        processor_time(*each, folder)
    result = [(processor_time(*new, folder), processor_time(*old, folder)) for _ in range(pairs)]
    first, second = (statistics.median(times) for times in zip(*result, strict=True))
    return first, second, statistics.median(a / b for a, b in result)


def main(arguments: Sequence[str] | None = None) -> None:
    """Print the table of the commands of each workbook."""
    parser = argparse.ArgumentParser(description="What commands cost in this version beside another.")
    parser.add_argument("old", help="a revision, or the path of a tree")
    parser.add_argument("--new", type=Path, default=ROOT, help="the tree of the new version; this one")
    parser.add_argument("--books", type=Path, nargs="+", default=[CASE_STUDY], help="workbooks; the case study")
    parser.add_argument("--commands", nargs="+", choices=("check", "simulate", "verify"), default=["check", "simulate"])
    parser.add_argument("--pairs", type=int, default=PAIRS, help=f"runs of each command in each version; {PAIRS}")
    given = parser.parse_args(arguments)
    books = [book.resolve() for book in given.books]
    new = given.new.resolve()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        with tree_of(given.old, folder) as old:
            times = ratio((new, _VERSION), (new, _BARE), given.pairs, folder)
            print(f"xlmc --version beside importing click: {times[0]:.3f} and {times[1]:.3f} s, ratio {times[2]:.2f}\n")
            print(f"| book | command | new, s | {given.old}, s | ratio |\n| --- | --- | ---: | ---: | ---: |")
            for book in books:
                for command in given.commands:
                    written = ("-o", str(folder / "results.xlsx"), "--overwrite") if command == "simulate" else ()
                    asked = ("-m", "xlmc", command, str(book), *written)
                    a, b, c = ratio((new, asked), (old, asked), given.pairs, folder)
                    print(f"| {book.stem} | `{command}` | {a:.3f} | {b:.3f} | {c:.3f} |", flush=True)
    print(f"\n{machine.sentence(machine.describe())}")


if __name__ == "__main__":
    main()
