"""Where a command's processor time goes: `python benchmarks/parts_of_a_command.py simulate examples/intersection.xlsx`.

The command runs several times in fresh processes, each of which is interrupted every few milliseconds of its processor
time to note what it is at. An import belongs to the package that is imported, with all that this imports in its turn;
all else to the function of `PARTS` that it was called from. What a process does before and after xlmc is not shown,
but for the import of click. Results of `simulate` go to a temporary folder.
"""

from __future__ import annotations

import argparse
import json
import os
import signal
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import FrameType
from typing import Final

__all__ = ["PARTS", "main", "part_of", "table"]

HERE: Final = Path(__file__).resolve()
PACKAGE: Final = str(HERE.parents[1] / "xlmc") + os.sep
RUNS: Final = 8
EVERY: Final = 0.004
"""Seconds of processor time; systems that count by coarser clocks take longer."""

PARTS: Final = {
    "loading the workbook": (
        "montecarlo/model/loading.py load",
        "excel/workbook/reader.py read_workbook",
        "montecarlo/definitions/definitions_reader.py read_definitions",
        "montecarlo/model/model.py __init__",
        "montecarlo/model/labels.py calculate_labels",
    ),
    "errors and answers at the base case": ("cli/check.py _show_base_case",),
    "the run": ("montecarlo/simulation/simulate.py run_model",),
    "sensitivities": ("analysis/studies/sensitivity/analysis.py sensitivities",),
    "draws before and after filters": ("outputs/filter_effect.py marginal", "outputs/filter_effect.py shapes"),
    "XML of result sheets": ("outputs/sheets/exact_book.py _write_rows",),
    "charts": ("outputs/sheets/exact_book.py _get_range_data", "outputs/sheets/exact_book.py _create_package"),
    "sheets into the workbook": ("excel/workbook/inject.py inject",),
    "looking the package over": ("excel/workbook/package_check.py faults",),
    "packing": ("excel/workbook/writer.py package_bytes",),
    "record, tables and other statistics": ("outputs/sheets/book.py build_sheets", "outputs/document/build.py *"),
    "other work of xlmc": ("*",),
}
"""The innermost of these functions of xlmc, by file and name, says to which part a moment belongs."""

_Place = tuple[str, str]
"""The file of a function, and its name."""


def part_of(stack: Sequence[_Place]) -> str:
    """Return the part that a moment belongs to, by the functions that called each other, outermost first."""
    own = [at for at, (file, _) in enumerate(stack) if file.startswith(PACKAGE)]
    if not own:
        return "the rest"
    behind = stack[own[-1] + 1 :]
    if any(file.endswith("dataclasses.py") for file, _ in behind):
        return "imports: making dataclasses"
    if stack[own[-1]][1] == "<module>" or any("importlib" in file for file, _ in behind):
        packages = [package for file, _ in behind if (package := _package(file))]
        return f"imports: {packages[0]}" if packages else "imports: modules of xlmc and of Python"
    for at in reversed(own):
        file, name = stack[at]
        place = file.removeprefix(PACKAGE).replace(os.sep, "/")
        for part, functions in PARTS.items():
            if f"{place} {name}" in functions or f"{place} *" in functions:
                return part
    return "other work of xlmc"


def _package(file: str) -> str | None:
    """Return the name of the installed package that a file belongs to; None if it is none."""
    _, result, below = file.replace(os.sep, "/").rpartition("/site-packages/")
    return below.split("/")[0] if result else None


def _watch(arguments: Sequence[str], target: Path) -> None:
    """Be the command, and write down how often it was found at each part."""
    seen: Counter[str] = Counter()

    def look(_number: int, frame: FrameType | None) -> None:
        stack = []
        while frame is not None:
            stack.append((frame.f_code.co_filename, frame.f_code.co_name))
            frame = frame.f_back
        seen[part_of(stack[::-1])] += 1

    signal.signal(signal.SIGPROF, look)
    signal.setitimer(signal.ITIMER_PROF, EVERY, EVERY)
    sys.argv = ["xlmc", *arguments]
    from xlmc.cli import main as command

    try:
        command()
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        times = os.times()
        target.write_text(json.dumps({"seen": seen, "seconds": times.user + times.system}), encoding="utf-8")


def table(seen: Mapping[str, int], seconds: float) -> str:
    """Return the rows, largest first, of which each has its share of the seconds."""
    whole = sum(seen.values())
    rows = [
        f"| {part} | {count / whole * seconds:.3f} | {count / whole:.1%} |"
        for part, count in sorted(seen.items(), key=lambda pair: -pair[1])
    ]
    return "\n".join(["| part | seconds | share |", "| --- | ---: | ---: |", *rows, f"| all | {seconds:.3f} |  |"])


def main(arguments: Sequence[str] | None = None) -> None:
    """Print the table of a command."""
    parser = argparse.ArgumentParser(description="Where a command's processor time goes.")
    parser.add_argument("--runs", type=int, default=RUNS)
    parser.add_argument("--watch", type=Path, help=argparse.SUPPRESS)
    parser.add_argument("command", nargs=argparse.REMAINDER, help="of xlmc, with its arguments")
    given = parser.parse_args(arguments)
    if given.watch:
        _watch(given.command, given.watch)
        return
    seen: Counter[str] = Counter()
    seconds = 0.0
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        environment = {key: value for key, value in os.environ.items() if key != "PYTHONDONTWRITEBYTECODE"}
        environment |= {"PYTHONPATH": str(HERE.parents[1]), "PYTHONPYCACHEPREFIX": str(folder / "bytecode")}
        written = ["-o", str(folder / "results.xlsx"), "--overwrite"] if given.command[0] == "simulate" else []
        asked = [sys.executable, str(HERE), "--watch", str(folder / "seen.json"), *given.command, *written]
        for number in range(given.runs + 1):
            done = subprocess.run(asked, env=environment, capture_output=True, text=True, check=False)
            if done.returncode not in (0, 1):  # 1: the run finished, and warns of its answer
                raise SystemExit(done.stderr)
            result = json.loads((folder / "seen.json").read_text(encoding="utf-8"))
            if number:  # the first one compiles
                seen.update(result["seen"])
                seconds += result["seconds"] / given.runs
    print(table(seen, seconds))


if __name__ == "__main__":
    main()
