"""How many formula cells of workbooks saved by Excel xlmc recomputes to Excel's own values, by cell and by shape.

`python benchmarks/conformance.py FOLDER` checks every workbook in the folder and in those below it. A shape is a
formula's text with relative references as distances, within one book; it matches when all its cells do. Cells that
change by themselves (volatile ones) and cells without a saved value are left out, and so are files that are damaged:
these are listed. Cells with functions that are not on the list in docs/functions.md count as not matched; the shares
without them are printed, too. Refused shapes are listed by reason and differing ones one by one. Exit code 1 where a
cell differs.
"""

from __future__ import annotations

import argparse
import csv
import re
import sys
import zipfile
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from xlmc.analysis.studies.verify import CellCheck, Status, verify
from xlmc.errors import WorkbookError
from xlmc.excel.formula.shape import shape_of
from xlmc.excel.workbook.reader import read_workbook

ENDINGS = (".xlsx", ".xlsm")
LEFT_OUT = (Status.VOLATILE, Status.NOT_CACHED)
VOLATILE = re.compile(r"\b(CELL|INFO)\(")
"""What changes in Excel without its arguments, and what xlmc computes in part only."""
NOT_LISTED = re.compile(r"xlmc does not compute the function \S+ of Excel|the function \S+ is not known to xlmc")
"""Why a cell is refused whose formula calls a function that docs/functions.md does not list."""
ENCRYPTED = b"\xd0\xcf\x11\xe0"
"""How a package begins that Excel encrypted."""
WHOLE_BOOK = "the whole book"
"""The one shape of a book that is refused as a whole."""


@dataclass(frozen=True, slots=True)
class Checked:
    """A formula cell: of which book, of which shape, and what came of it; no `check` in a book that is refused."""

    book: str
    shape: str
    status: Status
    reason: str = ""
    check: CellCheck | None = None

    @property
    def listed(self) -> bool:
        """Whether docs/functions.md lists all functions that it calls, as far as they are known."""
        return NOT_LISTED.fullmatch(self.reason) is None


@dataclass
class Conformance:
    """All formula cells of a folder that count, by book, and the files that are no whole workbooks."""

    books: dict[str, list[Checked]] = field(default_factory=dict)
    damaged: list[str] = field(default_factory=list)

    def cells(self) -> list[Checked]:
        """The cells of all books."""
        return [cell for cells in self.books.values() for cell in cells]

    def shapes(self) -> dict[tuple[str, str], list[Checked]]:
        """Book and shape -> its cells."""
        result: dict[tuple[str, str], list[Checked]] = defaultdict(list)
        for cell in self.cells():
            result[cell.book, cell.shape].append(cell)
        return result

    def cell_share(self, status: Status = Status.MATCHED) -> float:
        """Share of the cells that have that status."""
        return _share(cell.status is status for cell in self.cells())

    def shape_share(self) -> float:
        """Share of the shapes all of whose cells match."""
        return _share(_matches(cells) for cells in self.shapes().values())

    def of_listed_functions(self) -> Conformance:
        """The same without the shapes that call functions which docs/functions.md does not list."""
        apart = {key for key, cells in self.shapes().items() if not all(cell.listed for cell in cells)}
        kept = {
            book: [cell for cell in cells if (cell.book, cell.shape) not in apart] for book, cells in self.books.items()
        }
        return Conformance(kept, self.damaged)

    def book_shares(self) -> list[float]:
        """Share of the cells that match, of every book that has any."""
        return [_share(cell.status is Status.MATCHED for cell in cells) for cells in self.books.values() if cells]


def _share(truths: Iterable[bool]) -> float:
    listed = list(truths)
    return sum(listed) / len(listed) if listed else 1.0


def _matches(cells: list[Checked]) -> bool:
    return all(cell.status is Status.MATCHED for cell in cells)


def check_folder(folder: Path) -> Conformance:
    """Recompute every workbook of a folder."""
    sizes = _listed_sizes(folder)
    result = Conformance()
    for path in sorted(path for path in folder.rglob("*") if path.suffix.lower() in ENDINGS):
        if _is_damaged(path):
            result.damaged.append(path.name)
        else:
            result.books[path.name] = list(check_book(path, sizes))
    return result


def _is_damaged(path: Path) -> bool:
    """Whether a file is no package, or one whose parts are not what was packed; an encrypted workbook is whole."""
    if path.read_bytes()[: len(ENCRYPTED)] == ENCRYPTED:
        return False
    try:
        with zipfile.ZipFile(path) as package:
            return package.testzip() is not None
    except zipfile.BadZipFile:
        return True


def check_book(path: Path, sizes: dict[str, int]) -> Iterator[Checked]:
    """The formula cells of one workbook that count.

    Args:
        path: of the workbook.
        sizes: file name -> its number of formula cells, for books that are refused; what is not here is counted.
    """
    try:
        book = read_workbook(path)
        checks = verify(book).cells
    except WorkbookError as refused:
        size = sizes[path.name] if path.name in sizes else _formulas_written(path)
        yield from [Checked(path.name, WHOLE_BOOK, Status.UNSUPPORTED, refused.message)] * size
        return
    for check in checks:
        formula = book.content(check.anchor or check.cell).formula
        if formula is not None and not _is_left_out(check):
            shape = shape_of(formula.text, formula.row, formula.column)
            yield Checked(path.name, shape, check.status, check.reason, check)


def _is_left_out(check: CellCheck) -> bool:
    """Whether a cell has no one value: it is volatile, in xlmc or at least in Excel, or nothing is saved for it."""
    volatile = VOLATILE.search(check.formula.upper()) is not None
    return check.status in LEFT_OUT or (check.status is Status.UNSUPPORTED and volatile)


def _listed_sizes(folder: Path) -> dict[str, int]:
    """File name -> number of formula cells, as `INDEX.tsv` lists them, if there is one."""
    index = folder / "INDEX.tsv"
    if not index.exists():
        return {}
    with index.open(encoding="utf-8") as lines:
        return {row["file"]: int(row["formula_cells"]) for row in csv.DictReader(lines, delimiter="\t")}


def _formulas_written(path: Path) -> int:
    """How many formulas the sheets of a package hold; 1 for what is encrypted, so that the book counts."""
    try:
        with zipfile.ZipFile(path) as package:
            sheets = [name for name in package.namelist() if re.fullmatch(r"xl/worksheets/[^/]+\.xml", name)]
            return sum(len(re.findall(rb"<(?:\w+:)?f[ >/]", package.read(name))) for name in sheets)
    except zipfile.BadZipFile:
        return 1


def lines_of(conformance: Conformance) -> Iterator[str]:
    """What is printed."""
    cells, shapes = conformance.cells(), conformance.shapes()
    yield _line("cells", [cell.status for cell in cells])
    yield _line("shapes", [_worst(shape) for shape in shapes.values()])
    yield from _apart(conformance)
    yield from (f"damaged, not counted: {name}" for name in conformance.damaged)
    yield from _by_reason(shapes)
    yield from _differing(cells)


def _apart(conformance: Conformance) -> Iterator[str]:
    """The shares of formulas that only call functions on the list."""
    listed = conformance.of_listed_functions()
    cells, shapes = (
        len(a) - len(b) for a, b in ((conformance.cells(), listed.cells()), (conformance.shapes(), listed.shapes()))
    )
    if shapes:
        counts = f"{cells:,} cell{'s' * (cells != 1)} ({shapes:,} shape{'s' * (shapes != 1)})"
        yield (
            f"without {counts} of functions that docs/functions.md does not list: "
            f"{listed.cell_share():.3%} of cells and {listed.shape_share():.3%} of shapes match"
        )


def _line(what: str, statuses: list[Status]) -> str:
    counts = Counter(statuses)
    parts = [
        f"{counts[status]:,} {status.value} ({counts[status] / max(len(statuses), 1):.3%})"
        for status in (Status.MATCHED, Status.DIFFERING, Status.UNSUPPORTED)
    ]
    return f"{len(statuses):,} {what}: " + ", ".join(parts)


def _worst(cells: list[Checked]) -> Status:
    statuses = {cell.status for cell in cells}
    return next(s for s in (Status.DIFFERING, Status.UNSUPPORTED, Status.MATCHED) if s in statuses)


def _by_reason(shapes: dict[tuple[str, str], list[Checked]]) -> Iterator[str]:
    groups: dict[str, list[Checked]] = defaultdict(list)
    for cells in shapes.values():
        refused = [cell for cell in cells if cell.status is Status.UNSUPPORTED]
        if refused:
            groups[refused[0].reason].append(refused[0])
    for reason, first in sorted(groups.items(), key=lambda item: -len(item[1])):
        yield f"\nrefused, {len(first)} shape{'s' * (len(first) != 1)}: {reason}"
        yield from (f"  {_where(cell)}" for cell in first)


def _differing(cells: list[Checked]) -> Iterator[str]:
    differing = [cell for cell in cells if cell.status is Status.DIFFERING]
    if differing:
        yield f"\ndiffering, {len(differing)} cells"
    for cell in differing:
        assert cell.check is not None
        yield f"  {_where(cell)}\n    Excel: {cell.check.expected!r}\n    xlmc:  {cell.check.got!r}"


def _where(cell: Checked) -> str:
    return cell.book if cell.check is None else f"{cell.book} {cell.check.cell} {cell.check.formula}"


def main(given: Sequence[str] | None = None) -> int:
    """Print how a folder conforms; 1 where a cell differs."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, help="a folder of workbooks that Excel saved")
    folder = parser.parse_args(given).folder
    if not folder.is_dir():
        parser.error(f"{folder} is no folder")
    result = check_folder(folder)
    print("\n".join(lines_of(result)))
    return int(result.cell_share(Status.DIFFERING) > 0)


if __name__ == "__main__":
    sys.exit(main())
