"""Numbers of definitions that formulas compute, as people read them: `180,000 (=Estimate!B2)`, at the base case."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Final

from xlmc.excel.address import Cell, host_of
from xlmc.excel.workbook.workbook import Workbook
from xlmc.montecarlo.definitions.definitions import CUTOFFS, Assumption, Definitions, Filter, StatedNumber
from xlmc.montecarlo.definitions.forms import PLAIN, Form
from xlmc.montecarlo.definitions.stating import Kind
from xlmc.montecarlo.model.cell_forms import forms_of

__all__ = ["with_stated_formulas"]

_LONGEST: Final = 40
"""Characters of a formula; a longer one is named by its cell."""

_FIRST_DATE: Final = 10_000.0
"""Days: from 1927 on. A smaller number in the row of a date is a span, such as its standard deviation."""

_ENDS: Final = {"low", "high", "likeliest", "low_likeliest", "high_likeliest", "top", "bottom", "midpoint", *CUTOFFS}
_OF_QUANTITY: Final = frozenset({*_ENDS, "mean", "std_dev", "location", "scale", "deductible", "limit"})
"""Parameters that are in the unit of what is drawn; others, such as shapes and rates, are not."""

Values = Callable[[Sequence[Cell]], Mapping[Cell, float]]


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
    definitions = _in_their_forms(workbook, definitions)
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
    found = {cell: workbook.content(cell).value for cell in cells}
    return {
        cell: float(value)
        for cell, value in found.items()
        if isinstance(value, int | float) and not isinstance(value, bool)
    }


def _assumption(
    workbook: Workbook, assumption: Assumption, read: Mapping[str, Cell], known: Mapping[Cell, float]
) -> Assumption:
    stated = {}
    computed = {**read, **assumption.formulas}
    (form,) = forms_of(workbook, [host_of(assumption.cell)]) if computed else (PLAIN,)
    for key, cell in computed.items():
        number = assumption.given.get(key)
        value = known.get(cell) if isinstance(number, Cell) or number is None else number
        own = value is not None and form.kind is not Kind.NUMBER and _is_of_quantity(key, value, form)
        stated[key] = _stated(workbook, cell, value, form if own else PLAIN)
    return replace(assumption, stated={**assumption.stated, **stated}) if stated else assumption


def _in_their_forms(workbook: Workbook, definitions: Definitions) -> Definitions:
    """Return the definitions with the numbers of assumptions whose cells show dates, percentages or money as such."""
    asked = definitions.assumptions
    forms = zip(asked, forms_of(workbook, [host_of(each.cell) for each in asked]), strict=True)
    written = {each.name: _written(each, form) for each, form in forms if form.kind is not Kind.NUMBER}
    if not written:
        return definitions
    return replace(definitions, assumptions=tuple(replace(a, stated=written.get(a.name, a.stated)) for a in asked))


def _written(assumption: Assumption, form: Form) -> dict[str, StatedNumber]:
    """Return the numbers of an assumption that are values of its quantity, in the form of its cell."""
    return {
        key: StatedNumber(None, form.number(value))
        for key, value in assumption.given.items()
        if not isinstance(value, Cell) and _is_of_quantity(key, value, form)
    }


def _is_of_quantity(key: str, value: float, form: Form) -> bool:
    """Whether a number is a value of the quantity itself, or a distance of such; of dates a value alone."""
    if form.kind is Kind.DATE:
        return value >= _FIRST_DATE
    return key in _OF_QUANTITY or (key[:1] == "p" and key[1:2].isdigit())


def _filter(workbook: Workbook, filter_: Filter, known: Mapping[Cell, float]) -> Filter:
    stated = {key: _stated(workbook, cell, known.get(cell)) for key, cell in filter_.formulas.items()}
    return replace(filter_, stated=stated) if stated else filter_


def _stated(workbook: Workbook, cell: Cell, value: float | None, form: Form = PLAIN) -> StatedNumber:
    formula = workbook.content(cell).formula
    text = "" if formula is None else f"={formula.text}"
    whole = text if "!" in text or "[" in text else f"{cell}: {text}"
    return StatedNumber(value, whole if 0 < len(text) <= _LONGEST else str(cell), form)
