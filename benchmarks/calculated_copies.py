"""Whether `xlmc calculate` gives back what Excel saved: of workbooks as they are, and with the values taken out.

`python benchmarks/calculated_copies.py FOLDER` looks at every workbook in the folder. As it is, no value may change
that `xlmc verify` counts as matched, and no part but sheets with a differing cell. With the values of all formulas
taken out, the copy must hold Excel's values again: cells are counted that come back, that differ, and that have no
value, by whether `verify` matches them. `--copies TO` keeps these copies; openpyxl reads each, and LibreOffice, where
it is installed, opens each. Exit code 1 where a matched value changed or a copy does not open.
"""

from __future__ import annotations

import argparse
import re
import shutil
import subprocess
import sys
import tempfile
import warnings
from collections import Counter
from pathlib import Path

import openpyxl

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from xlmc.analysis.studies.verify import Status, verify
from xlmc.engine.calculation import Calculator
from xlmc.engine.saved_values import same_value
from xlmc.errors import XlmcError
from xlmc.excel.workbook.calculated_copy import copy_with_values
from xlmc.excel.workbook.reader import read_workbook
from xlmc.excel.workbook.writer import package_bytes

VALUE = re.compile(
    rb"(?P<cell><(?:\w+:)?c\b[^>]*>)(?P<formula><(?:\w+:)?f\b(?:[^>]*/>|[^>]*>[^<]*</(?:\w+:)?f>))"
    rb"<(?:\w+:)?v\b(?:[^>]*/>|[^>]*>[^<]*</(?:\w+:)?v>)"
)
TYPE = re.compile(rb"""\s+t\s*=\s*(?:"[^"]*"|'[^']*')""")


def without_values(parts):
    """Return the package without the values that are saved with formulas."""
    bare = {
        name: VALUE.sub(lambda result: TYPE.sub(b"", result["cell"]) + result["formula"], xml)
        for name, xml in parts.items()
        if b"sheetData" in xml[:100_000] and name.endswith(".xml")
    }
    return {**parts, **bare}


def look_at(path, copies, counts):
    """Count what comes of a workbook, and return the faults."""
    book = read_workbook(path)
    checked = verify(book)
    matched = {check.cell for check in checked.of(Status.MATCHED)}
    differing = {check.cell for check in checked.of(Status.DIFFERING)}
    result = Calculator(book).calculate()
    same = copy_with_values(book, {}, result.values, result.unknown)
    changed = [cell for cell in (*result.values, *result.unknown) if cell in matched]
    parts = read_workbook(same, path.name).parts
    others = {name for name in parts if parts[name] != book.parts.get(name)} - {
        book.sheets[cell.sheet].part for cell in (*differing, *result.values)
    }
    bare = read_workbook(package_bytes(without_values(book.parts)), path.name)
    again = Calculator(bare).calculate()
    for cell in (check.cell for check in checked.cells):
        kind = "matched" if cell in matched else "others"
        saved, got = book.content(cell).value, again.values.get(cell)
        counts[kind, "no value" if got is None else "back" if same_value(saved, got) else "differ"] += 1
        if kind == "matched" and got is not None and not same_value(saved, got):
            print(f"{path.name} {cell}: {saved!r} came back as {got!r}")
    target = copies / path.name
    target.write_bytes(copy_with_values(bare, {}, again.values, again.unknown))
    try:
        openpyxl.load_workbook(path)
    except Exception:  # openpyxl does not read the original either
        counts["openpyxl", "reads no original"] += 1
    else:
        openpyxl.load_workbook(target, data_only=True)
        counts["openpyxl", "reads"] += 1
    return [f"{path.name} {cell}: a matched value changed" for cell in changed] + [
        f"{path.name}: the part {name} changed" for name in others
    ]


def opened(copies, originals):
    """Return the copies that LibreOffice does not open, though it opens the original."""
    with tempfile.TemporaryDirectory() as folder:
        one, other = Path(folder) / "copies", Path(folder) / "originals"
        for files, to in ((copies, one), (originals, other)):
            run = ["soffice", f"-env:UserInstallation=file://{folder}/profile", "--headless", "--convert-to", "ods"]
            subprocess.run(
                [*run, "--outdir", str(to), *map(str, files)], capture_output=True, check=False, timeout=3_000
            )
        names = {path.stem for path in other.glob("*.ods")} - {path.stem for path in one.glob("*.ods")}
        return sorted(names), len([*one.glob("*.ods")])


def main():
    """Look at every workbook of a folder."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--copies", type=Path, help="Keep the calculated copies here.")
    given = parser.parse_args()
    warnings.simplefilter("ignore")
    copies = given.copies or Path(tempfile.mkdtemp())
    copies.mkdir(exist_ok=True)
    counts, faults, paths = Counter(), [], []
    for path in sorted(given.folder.rglob("*.xls[xm]")):
        try:
            faults += look_at(path, copies, counts)
            paths.append(path)
        except XlmcError as error:
            print(f"refused: {error}")
    for (kind, what), count in sorted(counts.items()):
        print(f"{kind:10} {what:20} {count:8,}")
    if shutil.which("soffice"):
        missing, many = opened([copies / path.name for path in paths], paths)
        print(f"LibreOffice opens {many:,} of {len(paths):,} copies")
        faults += [f"LibreOffice opens {name}, and not its copy" for name in missing]
    print("\n".join(faults) or "nothing that was right has changed")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
