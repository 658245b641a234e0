"""Formulas that nobody would write, in plain, array and spilling cells, with assumptions varying in them."""

from __future__ import annotations

import dataclasses
import random
import re
from functools import cache
from pathlib import Path
from typing import Any, Final

import numpy as np

from fuzzing import grammar
from fuzzing.books import MAIN, Sheet, Table, cell, packed, parts_of
from fuzzing.inputs import Disagreement, Input, Reached, steps_of
from fuzzing.splicing import spliced
from xlmc.engine.engines import ENGINES
from xlmc.excel.address import Area
from xlmc.excel.workbook.reader import read_workbook
from xlmc.excel.workbook.workbook import CellContent, Formula, Workbook
from xlmc.montecarlo.definitions.definitions import Definitions
from xlmc.montecarlo.definitions.definitions_reader import read_definitions
from xlmc.montecarlo.definitions.run_options import RunOptions
from xlmc.montecarlo.model.loading import build_model
from xlmc.montecarlo.model.model import CompiledModel
from xlmc.montecarlo.simulation.simulate import run_model
from xlmc.montecarlo.simulation.simulation import RunResult
from xlmc.outputs.summary import summarise, summary_text

__all__ = ["book_of", "make", "run"]

TRIALS: Final = 200
NAME: Final = "fuzz.xlsx"
_VALUES: Final = (1.25, 0.5, 3.0, -2.0)
_VOLATILE: Final = re.compile(r"RAND|NOW|TODAY|CELL\(|INFO\(", re.IGNORECASE)
_DRAWN: Final = re.compile(r"RAND|RISK|CB\.|\.?INV\(", re.IGNORECASE)
_STEPS: Final = {"jit": 0.05, "constants": 0.15, "file": 0.1, "summary": 0.15}
"""What else is asked, and in which share of the inputs."""

_METADATA: Final = (
    f'<metadata xmlns="{MAIN}" xmlns:xda="http://schemas.microsoft.com/office/spreadsheetml/2017/dynamicarray">'
    '<metadataTypes count="1"><metadataType name="XLDAPR"/></metadataTypes>'
    '<futureMetadata name="XLDAPR" count="1"><bk><extLst>'
    '<ext uri="{bdbb8cdc-fa1e-496e-a857-3c3f30c029c3}"><xda:dynamicArrayProperties fDynamic="1" fCollapsed="0"/></ext>'
    "</extLst></bk></futureMetadata>"
    '<cellMetadata count="1"><bk><rc t="1" v="0"/></bk></cellMetadata></metadata>'
)


def make(rng: random.Random) -> Input:
    """A book with one formula of chance in `S!F1`, which a forecast reads."""
    text = spliced(rng) if rng.random() < 0.2 else grammar.formula(rng)
    form = rng.choice(["plain", "plain", "array", "block", "dynamic"])
    steps = [form, *steps_of(rng, _STEPS)]
    if _DRAWN.search(text) and "file" not in steps:
        steps.append("file")
    return Input("formula.txt", text.encode("utf-8", "surrogatepass"), f"={text}", tuple(steps))


def book_of(text: str, form: str = "plain", kind: str = "varying") -> bytes:
    """The book.

    Args:
        text: the formula without its `=`.
        form: how `F1` holds it: `plain`, `array`, `block` (an array formula over four cells), `dynamic`.
        kind: of its assumptions: `varying`, `still` (they vary by nothing), `frozen`.
    """
    rows = {
        1: [cell(1, 1, _VALUES[0]), cell(1, 2, 4, "A1*3+A2"), cell(1, 3, 7.0), cell(1, 4, "a")],
        2: [cell(2, 1, _VALUES[1]), cell(2, 2, 2.0), cell(2, 3, True), cell(2, 4, "ab"), cell(2, 5, 4.0)],
        3: [cell(3, 1, _VALUES[2]), cell(3, 2, "#N/A"), cell(3, 3, 9, "A3^2"), cell(3, 4, 45000.0), cell(3, 5, 6.0)],
        4: [cell(4, 1, _VALUES[3]), cell(4, 2, 0, "IF(A4<0,A4,0)"), cell(4, 3, 1e300), cell(4, 4)],
        5: [cell(5, 1, 2.0), cell(5, 2, -1.0), cell(5, 3, 0.0), cell(5, 4, "3")],
        6: [cell(6, 1, "text"), cell(6, 2, 0.1), cell(6, 3, 5, "A2&1"), cell(6, 4, 12.0)],
        7: [cell(7, 1)],
        8: [cell(8, 1, "#DIV/0!"), cell(8, 8, "x"), cell(8, 9, "y")],
        9: [cell(9, 1, True), cell(9, 8, 1.0), cell(9, 9, 2, "A1")],
        10: [cell(10, 8, 2.0), cell(10, 9, 5.0)],
    }  # fmt: skip
    rows[1].append(_array(1, 5, "B1:B3*2", "E1:E3"))
    rows[1].append(_formula_cell(text, form))
    answers = {1: [cell(1, 1, "Name"), cell(1, 2, "Cell")], 2: [cell(2, 1, "y"), cell(2, 2, 0, "S!F1")]}
    headings = ("Name", "Cell", "Low", "High", "Frozen")
    assumptions = {5: [cell(5, n, heading) for n, heading in enumerate(headings, 1)]}
    for number, value in enumerate(_VALUES, 1):
        wide = 0.25 if kind == "varying" else 0.0
        held = [cell(5 + number, 5, True)] if kind == "frozen" else []
        assumptions[5 + number] = [
            cell(5 + number, 1, f"a{number}"),
            cell(5 + number, 2, 0, f"S!A{number}"),
            cell(5 + number, 3, value - wide),
            cell(5 + number, 4, value + wide),
            *held,
        ]
    tables = (Table("xlmc_forecasts", "A1:B2", ("Name", "Cell")), Table("xlmc_assumptions", "A5:E9", headings))
    sheets = {
        "S": Sheet(rows, (Table("Data", "H8:I10", ("x", "y")),)),
        "T": Sheet(answers | assumptions, tables),
    }
    names = {"rates": "S!$B$1:$B$6", "Twice": "LAMBDA(x,x*2)", "onlysheet": "S!$B$2"}
    parts = parts_of(sheets, names)
    return packed(_with_metadata(parts) if form == "dynamic" else parts)


def _array(row: int, column: int, formula: str, area: str) -> str:
    return cell(row, column, 0, formula, f' t="array" ref="{area}"')


def _formula_cell(text: str, form: str) -> str:
    if form == "plain":
        return cell(1, 6, 0, text)
    made = _array(1, 6, text, "F1:G2" if form == "block" else "F1")
    return made.replace("<c ", '<c cm="1" ') if form == "dynamic" else made


def _with_metadata(parts: dict[str, bytes]) -> dict[str, bytes]:
    """The parts that say which array formulas spill."""
    kind = "http://schemas.openxmlformats.org/officeDocument/2006/relationships/sheetMetadata"
    rels = parts["xl/_rels/workbook.xml.rels"]
    pointer = f'<Relationship Id="m" Type="{kind}" Target="metadata.xml"/></Relationships>'.encode()
    changed = {"xl/_rels/workbook.xml.rels": rels.replace(b"</Relationships>", pointer)}
    return parts | changed | {"xl/metadata.xml": _METADATA.encode()}


def run(given: Input, folder: Path) -> Reached:
    """Understand the book and run it.

    Steps: `file` makes a file of the book first; `summary` makes the table for people; `jit` runs it with the other
    engine too; `constants` compares assumptions that vary by nothing with frozen ones.

    Raises:
        Disagreement: two ways gave two answers.
        XlmcError: as xlmc does.
    """
    model = _model(given, "varying")
    result = run_model(model, RunOptions.of(trials=TRIALS))
    if "summary" in given.steps:
        summary_text(summarise(result))
    if "jit" in given.steps:
        _agree("numpy", result, "jit", run_model(model, RunOptions.of(trials=TRIALS, engine="jit")))
    if "constants" in given.steps and not _VOLATILE.search(given.said):
        still, frozen = (run_model(_model(given, kind), RunOptions.of(trials=8)) for kind in ("still", "frozen"))
        _agree("varying by nothing", still, "frozen", frozen)
    return Reached.RAN


def _model(given: Input, kind: str) -> CompiledModel:
    """The model of the book; without the step `file` its other cells are not read again."""
    text, form = given.said.removeprefix("="), given.steps[0]
    if "file" in given.steps:
        return build_model(read_workbook(book_of(text, form, kind), NAME), Path(NAME))
    workbook, definitions = _read(kind)
    area = None if form == "plain" else Area("S", 1, 6, *((2, 7) if form == "block" else (1, 6)))
    held = CellContent(0.0, Formula(text, 1, 6, area, dynamic=form == "dynamic"))
    sheet = workbook.sheets["S"]
    changed = dataclasses.replace(sheet, cells={**sheet.cells, (1, 6): held})
    whole = dataclasses.replace(workbook, sheets={**workbook.sheets, "S": changed})
    return CompiledModel(whole, definitions, Path(NAME))


@cache
def _read(kind: str) -> tuple[Workbook, Definitions]:
    """The book with a formula that will be replaced, and its definitions."""
    workbook = read_workbook(book_of("0", kind=kind), NAME)
    return workbook, read_definitions(workbook, ENGINES)


def _agree(one: str, first: RunResult, other: str, second: RunResult) -> None:
    """Both runs gave the same numbers, and the same faults.

    Raises:
        Disagreement: they did not.
    """
    faults = [dict(result.faults["y"]) for result in (first, second)]
    numbers: list[Any] = [np.asarray(results.forecasts["y"]) for results in (first, second)]
    if faults[0] != faults[1]:
        raise Disagreement(f"{one}: {faults[0]}, {other}: {faults[1]}")
    same = np.isclose(numbers[0], numbers[1], rtol=1e-9, atol=1e-300, equal_nan=True)
    if not np.all(same):
        at = int(np.argmin(same))
        raise Disagreement(f"{one}: {numbers[0][at]!r}, {other}: {numbers[1][at]!r} in trial {at}")
