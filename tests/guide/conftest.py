"""A person who follows the guide: types what its tables say into a fresh template, saves in Excel, runs."""

from __future__ import annotations

import re
import sys
import zipfile
from collections.abc import Callable
from pathlib import Path
from xml.sax.saxutils import escape

import openpyxl
import pytest
from simulated import simulated
from typed_cells import with_typed

from xlmc.excel.address import parse_address
from xlmc.excel.workbook.reader import read_workbook
from xlmc.excel.workbook.workbook import Workbook
from xlmc.montecarlo.model.loading import load
from xlmc.montecarlo.simulation.simulation import RunResult

ROOT = Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT))

GUIDE = (ROOT / "docs" / "guide.md").read_text(encoding="utf-8")
RANGES = re.findall(r"^\| `(\w+)` \| ([^|]+) \| ([-\d.]+) \| ([-\d.]+) \| ([^|]+) \|$", GUIDE, re.MULTILINE)
FILTERS = re.findall(r"^\| ([^|]+) \| ((?:at least|above) [^|]+) \| ([^|]+) \|$", GUIDE, re.MULTILINE)
NAMES = re.findall(r"`(Vehicle \d)` by `(\w+)`", GUIDE)
COLUMNS = ("at least", "at most", "above", "below")

_CELL = re.compile(r'<c r="([A-Z]+)(\d+)"([^>]*)>(<f>[^<]*</f>)<v\s*(?:/>|></v>)')


def _type(book: openpyxl.Workbook) -> None:
    for cell in book["Inputs"][4]:
        cell.value = dict(NAMES).get(cell.value, cell.value)
    heads = {cell.value: cell.column for cell in book["Inputs"][5]}
    rows = {row[heads["Cell name"] - 1].value: row[0].row for row in book["Inputs"].iter_rows(min_row=6)}
    for symbol, _, low, high, source in RANGES:
        message = {"Value": (float(low) + float(high)) / 2, "Low": float(low), "High": float(high), "Source": source}
        for head, value in message.items():
            book["Inputs"].cell(rows[symbol], heads[head], value)
    wanted = book["Results wanted"]
    named = [cell.value for cell in book["Inputs"][4]]
    shown = {f'={cell}&"': named[named.index(cell) + 1] for cell in ("vehicle_1", "vehicle_2")}
    rows = {_label(row[0].value, shown): row[0].row for row in wanted.iter_rows(min_row=22, max_row=30)}
    for name, limits, because in FILTERS:
        given = {text.rpartition(" ")[0]: float(text.rpartition(" ")[2]) for text in limits.split(", ")}
        for column, limit in enumerate(COLUMNS, 3):
            wanted.cell(rows[name], column, given.get(limit))
        wanted.cell(rows[name], 7, because)


def _label(written: str | None, shown: dict[str, str]) -> str | None:
    """The text that a label's formula shows, where it begins with the name of a vehicle."""
    start = next((start for start in shown if written and written.startswith(start)), None)
    return written if start is None or written is None else shown[start] + written.removeprefix(start).rstrip('"')


def _saved_by_excel(book: openpyxl.Workbook, path: Path) -> None:
    """Save with a value beside every formula, which openpyxl does not write."""
    from templates.writer.cached import computed

    book.save(path)
    values = computed(read_workbook(path))
    with zipfile.ZipFile(path) as package:
        parts = {name: package.read(name) for name in package.namelist()}
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as package:
        for name, data in parts.items():
            result = re.fullmatch(r"xl/worksheets/sheet(\d+)\.xml", name)
            sheet = book.sheetnames[int(result[1]) - 1] if result else ""
            package.writestr(name, _CELL.sub(_valued(sheet, values), data.decode()) if result else data)


def _valued(sheet: str, values) -> Callable[[re.Match[str]], str]:
    def write(match: re.Match[str]) -> str:
        column, row, attributes, formula = match.groups()
        value = values[sheet, int(row) - 1, openpyxl.utils.column_index_from_string(column) - 1]
        kind = {bool: ' t="b"', str: ' t="str"'}.get(type(value), "")
        text = str(int(value)) if isinstance(value, bool) else escape(value) if isinstance(value, str) else repr(value)
        return f'<c r="{column}{row}"{attributes}{kind}>{formula}<v>{text}</v>'

    return write


@pytest.fixture(scope="session")
def tables() -> dict[str, list[tuple[str, ...]]]:
    """What the guide's tables say: `ranges`, `filters`, and what `names` are replaced by what."""
    return {"ranges": RANGES, "filters": FILTERS, "names": NAMES}


@pytest.fixture(scope="session")
def case(tmp_path_factory) -> Path:
    """The case as the guide leaves it before the first run: the template, with what the guide says in it."""
    path = tmp_path_factory.mktemp("guide") / "my-case.xlsx"
    book = openpyxl.load_workbook(ROOT / "templates" / "planar-impact.xlsx")
    _type(book)
    _saved_by_excel(book, path)
    return path


@pytest.fixture(scope="session")
def workbook(case) -> Workbook:
    """The case, read."""
    return read_workbook(case)


@pytest.fixture(scope="session")
def run(case) -> RunResult:
    """The run of section 7."""
    return simulated(load(case))


@pytest.fixture(scope="session")
def changed(workbook) -> Callable[..., Workbook]:
    """`changed({("Inputs", "D8"): 278})`: the case with other cells."""
    return lambda cells: with_typed(
        workbook, {parse_address(cell, sheet): each for (sheet, cell), each in cells.items()}
    )


@pytest.fixture(scope="session")
def variant(case, tmp_path_factory) -> Callable[..., Path]:
    """`variant({("Inputs", "D8"): 278})`: a file of the case with other cells, saved by openpyxl."""

    def change(cells: dict[tuple[str, str], object]) -> Path:
        book = openpyxl.load_workbook(case)
        for (sheet, cell), value in cells.items():
            book[sheet][cell] = value
        path = tmp_path_factory.mktemp("variant") / "my-case.xlsx"
        book.save(path)
        return path

    return change
