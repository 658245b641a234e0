"""The sheet `XLRisk`, where XLRisk keeps its settings and its list of outputs.

Settings stand beside their labels: Seed, Iterations, Latin Hypercube, and the macros to run around each iteration. The
list of outputs begins below the cell that the sheet's name `RiskOutputs` names, or below the headings under `Simulation
Outputs`: an address, as a text or as `=AddressWithSheet(Model!$B$3)`, and a name.

Source: the module UserInterface of XLRisk, which makes the sheet (github.com/pyscripter/XLRisk).
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Final

from xlmc.errors import DefinitionError, FormulaError
from xlmc.excel.address import Area, Cell, parse_address
from xlmc.excel.formula import Resolver
from xlmc.excel.formula.precedents import references
from xlmc.excel.workbook.workbook import CellContent, Formula, Sheet, Workbook
from xlmc.montecarlo.definitions.computed import Computed
from xlmc.montecarlo.definitions.definitions import Forecast, Settings
from xlmc.montecarlo.definitions.problems import Findings
from xlmc.montecarlo.definitions.tables.identity import Claims
from xlmc.montecarlo.definitions.tables.table_rows import as_text, number_in
from xlmc.montecarlo.distributions.spelling import name_key, plain
from xlmc.montecarlo.number_text import count_text, number_text

__all__ = ["XLRiskSheet", "read_xlrisk"]

_SHEET: Final = "xlrisk"
_LABELS: Final = {
    "seed": "seed",
    "iterations": "iterations",
    "latinhypercube": "latin hypercube",
    "macrotorunbeforeeachiteration": "macro",
    "macrotoruneachiteration": "macro",
    "macrotorunaftereachiteration": "macro",
    "macrobefore": "macro",
    "macroafter": "macro",
}
_OUTPUTS: Final = "simulationoutputs"
_CELL_CALL: Final = "AddressWithSheet("
_MOST_BLANK: Final = 2
"""Empty rows between a title and its headings."""

_MOST_ROWS: Final = 10_000
_MOST_CELLS: Final = 10_000


@dataclass(slots=True)
class XLRiskSheet:
    """What the sheet says.

    Attributes:
        name: of the sheet.
        seed, trials, hypercube: as far as it says so.
        outputs: row of the list -> name and cells of the outputs in it.
    """

    name: str
    seed: int | None = None
    trials: int | None = None
    hypercube: bool | None = None
    outputs: dict[Cell, tuple[str, tuple[Cell, ...]]] = field(default_factory=dict)

    def settings(self, own: Settings, stated: Collection[str], findings: Findings) -> Settings:
        """Return the settings with those of the sheet for all that the table `xlmc_settings` does not say.

        Args:
            own: of the table.
            stated: what is set there, by plain names.
            findings: takes the remark where they come from.
        """
        method = None if self.hypercube is None else "lhs" if self.hypercube else "mc"
        result: dict[str, int | str | None] = {"trials": self.trials, "seed": self.seed, "sampling": method}
        taken = {key: value for key, value in result.items() if value is not None and key not in stated}
        if own.stopping.has_goal:
            taken.pop("trials", None)
        words = [
            f"{key} {count_text(value)}" if isinstance(value, int) else f"{key} {value}" for key, value in taken.items()
        ]
        words += [] if "lognorm" in stated else ["RiskLognorm's meaning"]
        if words:
            findings.notice(f"{', '.join(words)} are those of the sheet {self.name}, as in XLRisk", self.name)
        return replace(own, **taken, lognorm=own.lognorm or "XLRisk")  # type: ignore[arg-type]  # by key

    def forecasts(self, computed: Computed, central: float, claims: Claims, findings: Findings) -> Iterator[Forecast]:
        """Return the outputs that nothing else marks as answers.

        Args:
            computed: which cells something gives a value.
            central: the share of the central range.
            claims: takes their names and cells.
            findings: takes remarks.
        """
        for row, (name, cells) in self.outputs.items():
            for cell in cells:
                if cell in claims.cells:
                    continue
                if not computed.at_all(cell):
                    findings.notice(
                        f"{cell}, an output of the sheet {self.name}, holds no formula: it is left out", row
                    )
                    continue
                claims.take_cell(cell, row)
                called = f"{name} ({cell})" if name and len(cells) > 1 else name or str(cell)
                if name_key(called) in claims.names:
                    called = f"{name} ({cell})"
                yield Forecast(claims.take_name(called, row), cell, row, central=central)


def read_xlrisk(workbook: Workbook, findings: Findings) -> XLRiskSheet | None:
    """Read what the workbook's sheet `XLRisk` says; None if it has none that XLRisk made.

    Args:
        workbook: that was read.
        findings: takes mistakes and remarks.
    """
    own = next((name for name in workbook.sheets if name.casefold() == _SHEET), None)
    if own is None:
        return None
    sheet = workbook.sheets[own]
    texts = {at: plain(content.value) for at, content in sheet.cells.items() if isinstance(content.value, str)}
    anchor = _anchor(workbook, sheet, texts)
    if anchor is None and not {"seed", "iterations"} & set(texts.values()):
        return None
    result = XLRiskSheet(sheet.name)
    with findings.recording():
        _read_settings(result, _values(sheet, texts), findings)
    if anchor is not None:
        for row, content, name in _rows(sheet, anchor):
            with findings.recording():
                result.outputs[row] = as_text(name.value), tuple(_cells_of(workbook, row, content))
    return result


def _values(sheet: Sheet, texts: Mapping[tuple[int, int], str]) -> dict[str, list[tuple[Cell, CellContent]]]:
    """List setting -> the cells right of its labels that hold something."""
    result: dict[str, list[tuple[Cell, CellContent]]] = {}
    for (row, column), text in sorted(texts.items()):
        content = sheet.cells.get((row, column + 1))
        if text in _LABELS and content is not None and not content.is_blank:
            result.setdefault(_LABELS[text], []).append((Cell(sheet.name, row, column + 1), content))
    return result


def _read_settings(
    sheet: XLRiskSheet, values: Mapping[str, list[tuple[Cell, CellContent]]], findings: Findings
) -> None:
    """Take the settings.

    Raises:
        DefinitionError: one is not what it must be, or a macro runs in each iteration.
    """
    for cell, content in values.get("macro", ()):
        if text := as_text(content.value):
            hint = "Clear the cell if the results do not need the macro, or put what it does into formulas"
            raise DefinitionError(
                f"XLRisk runs the macro {text!r} in each iteration; xlmc runs none", where=cell, hint=hint
            )
    for cell, content in values.get("iterations", ())[:1]:
        number = number_in("Iterations", content, cell)
        if number < 1 or number != int(number):
            hint = "Correct the number"
            raise DefinitionError(
                f"Iterations must be a whole number from 1 up, not {number_text(number)}", where=cell, hint=hint
            )
        sheet.trials = int(number)
    for cell, content in values.get("latin hypercube", ())[:1]:
        word = plain(as_text(content.value))
        if word not in _SWITCH:
            hint = "Type TRUE or FALSE"
            message = f"Latin Hypercube is {as_text(content.value)!r}, neither TRUE nor FALSE"
            raise DefinitionError(message, where=cell, hint=hint)
        sheet.hypercube = _SWITCH[word]
    for cell, content in values.get("seed", ())[:1]:
        number = number_in("Seed", content, cell)
        if number > 0 and number == int(number):
            sheet.seed = int(number)
        else:
            why = (
                "XLRisk's seed 0 is another one in each run"
                if number == 0
                else f"{number_text(number)} is no seed of xlmc"
            )
            findings.notice(f"{why}: the seed is that of the command, of xlmc_settings, or xlmc's own", cell)


_SWITCH: Final = {"true": True, "1": True, "yes": True, "false": False, "0": False, "no": False}


def _anchor(workbook: Workbook, sheet: Sheet, texts: Mapping[tuple[int, int], str]) -> tuple[int, int] | None:
    """Row and column of a heading of the list of outputs, or of its first row."""
    for name in workbook.names:
        if name.name.casefold() == "riskoutputs":
            try:
                cell = parse_address(name.text)
            except ValueError:
                continue
            if cell.sheet.casefold() == _SHEET:
                return (cell.row, cell.column) if isinstance(cell, Cell) else (cell.top, cell.left)
    return next((at for at, text in sorted(texts.items()) if text == _OUTPUTS), None)


def _rows(sheet: Sheet, anchor: tuple[int, int]) -> Iterator[tuple[Cell, CellContent, CellContent]]:
    """Return the rows of the list: its cell, and what address and name hold.

    The list is what stands together around its anchor, as Excel's current region; of headings, only addresses count.
    """
    top, column = anchor
    while (top - 1, column) in sheet.cells and not sheet.cells[top - 1, column].is_blank:
        top -= 1
    begun, gap = False, 0
    for row in range(top, top + _MOST_ROWS):
        content, name = (sheet.cells.get((row, at), CellContent()) for at in (column, column + 1))
        gap = gap + 1 if content.is_blank and name.is_blank else 0
        if gap and (begun or gap > _MOST_BLANK):
            return
        if not content.is_blank and (begun or content.formula is not None or "!" in as_text(content.value)):
            begun = True
            yield Cell(sheet.name, row, column), content, name


def _cells_of(workbook: Workbook, row: Cell, content: CellContent) -> Iterator[Cell]:
    """Return the cells that a row is about.

    Raises:
        DefinitionError: it names none, or one of a sheet that is not there.
    """
    for part in _parts(workbook, row, content):
        sheet = next((name for name in workbook.sheets if name.casefold() == part.sheet.casefold()), None)
        if sheet is None:
            raise DefinitionError(f"The output lies on a sheet {part.sheet!r} that is not there", where=row, hint=_CURE)
        if isinstance(part, Cell):
            yield Cell(sheet, part.row, part.column)
        elif part.rows * part.columns > _MOST_CELLS:
            raise DefinitionError(
                f"The output {part} has more than {count_text(_MOST_CELLS)} cells", where=row, hint=_CURE
            )
        else:
            yield from (Cell(sheet, each.row, each.column) for each in part.cells())


_CURE: Final = "Write its address, such as Model!$B$3, or delete the row"


def _parts(workbook: Workbook, row: Cell, content: CellContent) -> Iterator[Cell | Area]:
    """Return the cells and areas of a row, by its formula where it has one: that moves with the cells."""
    if content.formula is not None and _CELL_CALL.casefold() in content.formula.text.casefold():
        yield from _of_formula(workbook, row, content.formula)
        return
    text, sheet = as_text(content.value), None
    try:
        for each in text.split(","):
            part = parse_address(each, sheet)
            sheet = part.sheet
            yield part
    except ValueError:
        raise DefinitionError(f"{text!r} is no address of an output of XLRisk", where=row, hint=_CURE) from None


def _of_formula(workbook: Workbook, row: Cell, formula: Formula) -> Iterator[Cell | Area]:
    try:
        yield from references(Resolver(workbook).formula(row, formula))
    except FormulaError as error:
        raise DefinitionError(f"The output cannot be read: {error.message}", where=row, hint=_CURE) from error
