"""Numbers of definitions as people read them: in the form of their cells, and those that formulas compute with the
formula: `180,000 (=Estimate!B2)`, at the base case.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Final, TypeVar

from xlmc.excel.address import Cell, host_of
from xlmc.excel.workbook.workbook import Workbook
from xlmc.montecarlo.definitions.definitions import (
    Assumption,
    Decision,
    Definitions,
    Filter,
    Forecast,
    Solve,
    StatedNumber,
)
from xlmc.montecarlo.definitions.evidence import Evidence
from xlmc.montecarlo.definitions.forms import PLAIN
from xlmc.montecarlo.definitions.stating import Kind
from xlmc.montecarlo.model.cell_forms import forms_of

if TYPE_CHECKING:
    from xlmc.montecarlo.definitions.forms import Form
    from xlmc.montecarlo.definitions.scenarios import Scenario

__all__ = ["in_their_forms", "with_stated_formulas"]

_LONGEST: Final = 40
"""Characters of a formula; a longer one is named by its cell."""

Values = Callable[[Sequence[Cell]], Mapping[Cell, float]]
R = TypeVar("R", Assumption, Filter, Evidence, Decision)


def with_stated_formulas(
    workbook: Workbook, given: Definitions, definitions: Definitions, values: Values
) -> Definitions:
    """Return the definitions with each number that a formula computes as people read it.

    Args:
        workbook: that holds the formulas.
        given: the definitions as they were read.
        definitions: the same, with numbers where no assumption may vary them.
        values: computes cells at the base case, those that can be.
    """
    definitions = in_their_forms(workbook, definitions)
    limits = (*definitions.filters, *definitions.forecast_filters)
    asked: list[Assumption | Filter] = [*definitions.assumptions, *limits, *given.assumptions]
    if not any(each.formulas for each in asked):
        return definitions
    cells = [cell for each in asked for cell in each.formulas.values()]
    known = _saved(workbook, cells)
    missing = [cell for cell in dict.fromkeys(cells) if cell not in known]
    known = {**known, **values(missing)} if missing else known
    read = {each.name: each.formulas for each in given.assumptions}
    return replace(
        definitions,
        assumptions=tuple(
            _assumption(workbook, each, read.get(each.name, {}), known) for each in definitions.assumptions
        ),
        filters=tuple(_filter(workbook, each, known) for each in definitions.filters),
        forecast_filters=tuple(_filter(workbook, each, known) for each in definitions.forecast_filters),
    )


def _saved(workbook: Workbook, cells: Iterable[Cell]) -> dict[Cell, float]:
    """Return the values that the file holds; none where they may be older than the formulas."""
    if workbook.may_be_stale:
        return {}
    result = {cell: workbook.content(cell).value for cell in cells}
    return {
        cell: float(value)
        for cell, value in result.items()
        if isinstance(value, int | float) and not isinstance(value, bool)
    }


def _assumption(
    workbook: Workbook, assumption: Assumption, read: Mapping[str, Cell], known: Mapping[Cell, float]
) -> Assumption:
    stated = {}
    for key, cell in {**read, **assumption.formulas}.items():
        number = assumption.given.get(key)
        value = known.get(cell) if isinstance(number, Cell) or number is None else number
        stated[key] = _stated(workbook, cell, value)
    return replace(assumption, stated={**assumption.stated, **stated}) if stated else assumption


def in_their_forms(workbook: Workbook, definitions: Definitions) -> Definitions:
    """Return the definitions with the forms of those of their cells that show dates, percentages or money."""
    limits = (*definitions.filters, *definitions.forecast_filters, *definitions.unused)
    rows: list[Assumption | Filter | Forecast | Evidence | Decision] = [*definitions.assumptions, *limits]
    rows += [*definitions.forecasts, *definitions.evidence, *definitions.decisions]
    solved = (cell for each in definitions.solves for cell in (each.cell, each.by))
    read = (*(each.cell for each in rows), *solved)
    cells = [*dict.fromkeys([*map(host_of, read), *_typed(definitions.scenarios)])]
    forms = dict(zip(cells, forms_of(workbook, cells), strict=True))
    known = {cell: form for cell, form in forms.items() if form.kind is not Kind.NUMBER}
    if not known:
        return definitions

    def row(each: R) -> R:
        form = known.get(host_of(each.cell))
        return each if form is None else replace(each, form=form)

    def limited(each: Filter) -> Filter:
        return row(each) if each.evidence is None else replace(row(each), evidence=row(each.evidence))

    def solve(each: Solve) -> Solve:
        form, form_by = (known.get(host_of(cell), PLAIN) for cell in (each.cell, each.by))
        return replace(each, form=form, form_by=form_by)

    def forecast(each: Forecast) -> Forecast:
        form = known.get(host_of(each.cell), PLAIN)
        if form is PLAIN or each.kind not in (None, form.kind):
            return each
        return replace(each, form=form.beside_units(each.units))

    return replace(
        definitions,
        assumptions=tuple(map(row, definitions.assumptions)),
        filters=tuple(map(limited, definitions.filters)),
        forecast_filters=tuple(map(limited, definitions.forecast_filters)),
        unused=tuple(map(limited, definitions.unused)),
        forecasts=tuple(map(forecast, definitions.forecasts)),
        evidence=tuple(map(row, definitions.evidence)),
        solves=tuple(map(solve, definitions.solves)),
        scenarios=_scenarios_in_forms(definitions.scenarios, known),
        decisions=tuple(map(row, definitions.decisions)),
    )


def _filter(workbook: Workbook, filter_: Filter, known: Mapping[Cell, float]) -> Filter:
    stated = {key: _stated(workbook, cell, known.get(cell)) for key, cell in filter_.formulas.items()}
    return replace(filter_, stated=stated) if stated else filter_


def _stated(workbook: Workbook, cell: Cell, value: float | None) -> StatedNumber:
    formula = workbook.content(cell).formula
    text = "" if formula is None else f"={formula.text}"
    whole = text if "!" in text or "[" in text else f"{cell}: {text}"
    return StatedNumber(value, whole if 0 < len(text) <= _LONGEST else str(cell))


def _typed(scenarios: Sequence[Scenario]) -> list[Cell]:
    """Return the cells that scenarios type values into."""
    if not scenarios:
        return []
    from xlmc.montecarlo.definitions.scenarios import Typed  # few workbooks have them

    return [change.cell for each in scenarios for change in each.changes if isinstance(change, Typed)]


def _scenarios_in_forms(scenarios: Sequence[Scenario], known: Mapping[Cell, Form]) -> tuple[Scenario, ...]:
    """Return the scenarios with these forms of the cells that values are typed into."""
    if not scenarios:
        return ()
    from xlmc.montecarlo.definitions.scenarios import Change, Typed

    def in_form(change: Change) -> Change:
        if isinstance(change, Typed) and change.cell in known:
            return replace(change, form=known[change.cell])
        return change

    return tuple(replace(each, changes=tuple(map(in_form, each.changes))) for each in scenarios)
