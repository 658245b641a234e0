"""How `xlmc fit --tests` copies rows of crash tests into a workbook's sheet Stiffness, and what these then give."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Final

from xlmc.errors import DefinitionError
from xlmc.excel.address import Cell

if TYPE_CHECKING:
    from xlmc.excel.workbook.workbook import Workbook

__all__ = ["Copied", "prepare", "write"]

SHEET: Final = "Stiffness"
_NUMBERS: Final = ("weight", "speed", *(f"c{k}" for k in range(1, 7)), "width")
_PATTERNS: Final = {
    "weight": re.compile(r"\b(?:weight|mass)\b"),
    "speed": re.compile(r"\b(?:speed|velocity)\b"),
    "width": re.compile(r"\b(?:width|length)\b"),
    **{f"c{k}": re.compile(rf"\bc\s*{k}\b") for k in range(1, 7)},
    "vehicle": re.compile(r"\bvehicle\b"),
    "test": re.compile(r"\btest\b|\bno\b"),
}
"""What a column is -> words of its heading; the first that fits counts."""
_UNIT: Final = re.compile(r"[,(\[]\s*([^,()\[\]]+?)\s*[)\]]?\s*$")
_GIVES: Final = ("tests_{j}", "b1_tests_{j}", "b1_sd_{j}", "b0_used_{j}", "b1_used_{j}", "A_{j}", "B_{j}", "G_{j}")

Item = str | float | None


@dataclass(frozen=True, slots=True)
class Copied:
    """A workbook with its new rows, not written yet.

    Attributes:
        path: of the workbook.
        data: its new bytes.
        sha256: of the file as it was read.
        first, last: the rows that the tests take.
        gives: name of a quantity -> what its cell shows with the new tests.
    """

    path: Path
    data: bytes
    sha256: str
    first: int
    last: int
    gives: Mapping[str, float]


def prepare(path: Path, vehicle: int, source: Path, reference: str | None) -> Copied:
    """Read the tests and put them below those that the sheet has.

    Args:
        path: of the workbook that has the sheet.
        vehicle: 1 or 2.
        source: a CSV file, or a workbook.
        reference: the range of the workbook, its first row the headings.

    Raises:
        DefinitionError: a heading or a number is missing, a unit cannot be converted, or there is no room.
        WorkbookError: a file cannot be read, or a program has it open.
    """
    from xlmc.engine import calculate
    from xlmc.excel.workbook.injection.cell_edit import with_contents
    from xlmc.excel.workbook.package_check import checked_bytes
    from xlmc.excel.workbook.reader import read_workbook
    from xlmc.excel.workbook.target import refuse_into_other_format
    from xlmc.excel.workbook.writer import refuse_if_open

    refuse_if_open(path)
    workbook = read_workbook(path)
    refuse_into_other_format(path)
    headings, *tests = _rows(source, reference)
    contents = _contents(workbook, vehicle, source, headings, tests)
    sheet = workbook.sheets[SHEET]
    part = with_contents(workbook.parts[sheet.part], sheet.part, sheet.name, contents)
    data = checked_bytes({**workbook.parts, sheet.part: part}, workbook.parts)
    done = calculate(read_workbook(data, path.name))
    known, gives = {each.name for each in done.names}, {}
    for name in (each.format(j=vehicle) for each in _GIVES):
        value = done[name] if name in known else None
        if isinstance(value, float | int):
            gives[name] = float(value)
    rows = [row for row, _ in contents]
    return Copied(path, data, workbook.sha256, min(rows), max(rows), gives)


def write(copied: Copied) -> Path:
    """Replace the file, and give its path back.

    Raises:
        TakenError: it has changed since it was read, or a program has it open.
        WorkbookError: it cannot be written.
    """
    from xlmc.excel.workbook.target import refuse_into_source
    from xlmc.excel.workbook.writer import write_workbook

    write_workbook(copied.path, copied.data, lambda: refuse_into_source(copied.path, copied.sha256, "Copy again"))
    return copied.path


def _rows(source: Path, reference: str | None) -> list[list[Item]]:
    """Return headings and rows; those without any content are left out."""
    rows = _of_csv(source) if reference is None else _of_range(source, reference)
    rows = [row for row in rows if any(item not in (None, "") for item in row)]
    if len(rows) < 2:
        raise DefinitionError(
            f"{source} holds no crash tests", hint="The first row has headings, each further one is a test."
        )
    return rows


def _of_csv(source: Path) -> list[list[Item]]:
    from xlmc.excel.workbook.typed_values import lines_of

    _, lines = lines_of(source)
    return [[item.strip() for item in row] for _, row in lines]


def _of_range(source: Path, reference: str) -> list[list[Item]]:
    from xlmc.engine import calculate
    from xlmc.excel.workbook.reader import read_workbook
    from xlmc.montecarlo.definitions.cell_references import area_of_reference

    workbook = read_workbook(source)
    only_sheet = next(iter(workbook.sheets)) if len(workbook.sheets) == 1 else None
    area = area_of_reference(workbook, reference, only_sheet, source)
    cells = calculate(workbook).sheets[area.sheet].cells

    def item(row: int, column: int) -> Item:
        value = cells[row, column].value if (row, column) in cells else None
        return value if isinstance(value, float | str) else None

    return [
        [item(row, column) for column in range(area.left, area.left + area.columns)]
        for row in range(area.top, area.top + area.rows)
    ]


def _columns(headings: Iterable[object]) -> dict[str, tuple[int, str]]:
    """Return what each column is -> its place from 0, and its unit as the heading says it."""
    result: dict[str, tuple[int, str]] = {}
    for place, heading in enumerate(headings):
        text = heading.casefold() if isinstance(heading, str) else ""
        unit = _UNIT.search(text)
        plain = text[: unit.start()] if unit else text
        for what, pattern in _PATTERNS.items():
            if what not in result and pattern.search(plain):
                result[what] = place, unit[1] if unit else ""
                break
    return result


def _contents(
    workbook: Workbook, vehicle: int, source: Path, headings: Sequence[Item], tests: Sequence[Sequence[Item]]
) -> dict[tuple[int, int], str | float]:
    """Return what to write, by row and column."""
    if SHEET not in workbook.sheets:
        raise DefinitionError(
            f"The workbook has no sheet {SHEET}", hint="xlmc new crush-energy my-case.xlsx makes one that has."
        )
    cells = workbook.sheets[SHEET].cells
    head = next((row for row, column in sorted(cells) if column == 2 and _is_head(cells[row, column].value)), None)
    if head is None:
        raise DefinitionError("The sheet has no row of headings for tests", where=Cell(SHEET, 5, 1))
    there = _columns(cells[head, column].value if (head, column) in cells else "" for column in range(1, 12))
    here = _columns(headings)
    lacking = [what for what in _NUMBERS if what not in here]
    if lacking:
        raise DefinitionError(
            f"{source} has no column for {', '.join(lacking)}",
            hint="Its first row needs the headings weight, speed, C1 to C6 and width, with their units: Weight, lb.",
        )
    factors = {what: _factor(what, here[what][1], there[what][1], source) for what in _NUMBERS}
    first = _first_blank(workbook, head, len(tests))
    contents: dict[tuple[int, int], str | float] = {}
    for row, (number, test) in enumerate(enumerate(tests, 2), first):
        name = test[here["test"][0]] if "test" in here and here["test"][0] < len(test) else None
        contents[row, 1] = f"{source.name}: {name:g}" if isinstance(name, float) else f"{source.name}: {name or number}"
        contents[row, 2] = float(vehicle)
        for what in _NUMBERS:
            place = here[what][0]
            item = test[place] if place < len(test) else None
            contents[row, there[what][0] + 1] = factors[what] * _number(item, what, number, source)
    return contents


def _is_head(value: object) -> bool:
    return isinstance(value, str) and value.startswith("Vehicle")


def _factor(what: str, unit: str, wanted: str, source: Path) -> float:
    from xlmc.montecarlo.definitions.units import factor_between

    factor = factor_between(unit, wanted) if unit else 1.0
    if factor is None:
        raise DefinitionError(
            f"{source}: {what} is in {unit}, which is not converted to {wanted}", hint=f"Enter {what} in {wanted}."
        )
    return factor


def _first_blank(workbook: Workbook, head: int, tests: int) -> int:
    """Return the first row without a test; all that are needed lie before the formulas of the sheet end."""
    cells = workbook.sheets[SHEET].cells
    last = head
    while (last + 1, 12) in cells and cells[last + 1, 12].formula is not None:
        last += 1
    taken = [
        row for row, column in cells if head < row <= last and column <= 11 and cells[row, column].value is not None
    ]
    first = max(taken, default=head) + 1
    if first + tests - 1 > last:
        raise DefinitionError(
            f"The sheet has room for {last - first + 1} more tests, not for {tests}",
            where=Cell(SHEET, last, 1),
            hint="Clear tests that do not belong to this case.",
        )
    return first


def _number(item: Item, what: str, row: int, source: Path) -> float:
    if isinstance(item, str):
        try:
            return float(item)
        except ValueError:
            pass
    elif item is not None:
        return item
    message = f"'{item}'" if item else "blank"
    raise DefinitionError(f"{source}, row {row}: {what} is {message}", hint="Every test needs a number there.")
