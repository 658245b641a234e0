"""What the look at a result package costs: `python benchmarks/package_check.py [BOOK]`.

Prints the processor time of the command `xlmc simulate` on the workbook, that of its package check with the names that
are looked up before new parts are named, and their share, each the median of seven.
"""

from __future__ import annotations

import resource
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

from xlmc.excel.workbook import package, package_check
from xlmc.excel.workbook.injection.part_numbers import claimed_names
from xlmc.excel.workbook.package import read_parts

ROUNDS = 7


def of_command(book: Path, result: Path) -> float:
    """The processor time of the whole command."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    command = [sys.executable, "-m", "xlmc", "simulate", str(book), "-o", str(result), "--overwrite"]
    subprocess.run(command, check=True, capture_output=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def of_check(before: dict[str, bytes], after: dict[str, bytes]) -> float:
    """The processor time of the check alone."""
    package._pointers.cache_clear()
    start = time.process_time()
    claimed_names(before)
    package_check.faults(after, {name for name, content in after.items() if before.get(name) != content})
    return time.process_time() - start


def main(book: Path) -> None:
    """Measure in turn, and print."""
    runs, checks = [], []
    with tempfile.TemporaryDirectory() as folder:
        result = Path(folder, "results.xlsx")
        for _ in range(ROUNDS):
            runs.append(of_command(book, result))
            checks.append(of_check(read_parts(book.read_bytes()), read_parts(result.read_bytes())))
    run, check = statistics.median(runs), statistics.median(checks)
    print(f"simulate {run:.2f} s, check {check * 1000:.0f} ms: {check / run:.1%}")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else HERE.parent / "examples" / "intersection.xlsx")
