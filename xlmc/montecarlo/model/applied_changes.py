"""The model of a workbook with changes: a scenario, or what a person has just moved.

`applied(model, changes)` gives the model that the workbook would have with other numbers in its cells, and a run of it
is, bit for bit, a run of the edited workbook. Neither file nor formula is read again where only numbers of tables are
others: parameters and cutoffs of drawn assumptions, and limits of filters. A change of ranges alone then takes half a
millisecond, and compiled programs are used again. Another limit of a filter makes the program anew, with the same
native code: 1 ms with `numpy` for some dozens of formulas, 15 ms with `jit`. What holds an assumption, or lets a held
one be drawn, puts the cells in order again (15 ms); what is typed into other cells reads the definitions again, too
(20 ms).

For a picture that follows a hand: load the workbook once, keep the model, and for each move

    moved = applied(model, [Range("Friction", 0.6, 0.8)])     # always of the model that was loaded, from one thread
    run = simulate(moved, trials=50_000, engine="jit")

or, to move limits as fast as ranges, and to draw nothing twice, keep a `ReusingRunner` (`reusing_runner.py`), too.

Draws are keyed by the seed and an assumption's name, so those of assumptions that are not changed stay what they were.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from xlmc.engine.graph.lowering import Lowering
from xlmc.errors import DefinitionError
from xlmc.excel.address import Cell
from xlmc.excel.workbook.lazy_sheets import with_values
from xlmc.excel.workbook.workbook import CellValue
from xlmc.montecarlo.definitions.definitions import CUTOFFS, Assumption, Correlation, Definitions, Filter, Forecast
from xlmc.montecarlo.definitions.distribution import Distribution
from xlmc.montecarlo.definitions.evidence import SIZES
from xlmc.montecarlo.definitions.scenarios import (
    Band,
    Change,
    Correlated,
    Drawn,
    Frozen,
    Limits,
    Measured,
    Numbers,
    Range,
    Redrawn,
    Stated,
    Switched,
    Tabulated,
    Typed,
)
from xlmc.montecarlo.definitions.tables.changed_cells import cells_that_change, tables_of, use_cell
from xlmc.montecarlo.definitions.tables.evidence_rows import as_filter, check_sizes
from xlmc.montecarlo.definitions.tables.filters import LIMITS, contradiction
from xlmc.montecarlo.distributions.parameters import show
from xlmc.montecarlo.distributions.spelling import by_names, did_you_mean, name_key
from xlmc.montecarlo.model.draw_binding import draw_of
from xlmc.montecarlo.model.loading import filter_faults, model_with_values
from xlmc.montecarlo.model.model import CompiledModel
from xlmc.montecarlo.number_text import number_text
from xlmc.montecarlo.sampling.draws import Draw

__all__ = ["applied", "changed_cells", "edits", "reads_again"]


_OF_ALL: Final = ("xlmc_settings", "xlmc_scenarios", "xlmc_case")
"""Tables that a scenario cannot change."""


def applied(model: CompiledModel, changes: Iterable[Change]) -> CompiledModel:
    """Make the model with these changes; several of one assumption are made one after another.

    Raises:
        DefinitionError: there is no such assumption or filter, or a change is not possible: numbers that are no
            distribution, limits that contradict each other, a range for an assumption that is held. Where the change
            comes from a cell, the message names it.
        FormulaError: a cell cannot be computed then.
    """
    changes = tuple(changes)
    before = _with_typed(model, changes)
    definitions = _changed(before, changes)
    cells = changed_cells(before, definitions)[0]
    if before.reads_elsewhere(cells):
        again = model_with_values(model, {**_typed(changes), **cells}, _tabulated(changes), _switched(changes))
        definitions = _merged(again.definitions, before.definitions, definitions)
        before, workbook = again, again.workbook
    else:
        workbook = with_values(before.workbook, cells)
    result = before.changed(workbook, definitions)
    if _filters_of(result) != _filters_of(before) and (faults := filter_faults(result)):
        raise faults[0]
    return result


def reads_again(model: CompiledModel, changes: Iterable[Change]) -> bool:
    """Return whether these changes make `applied` read the workbook's definitions again.

    What earlier changes of the model have no cell for, such as a switch, would be lost then.

    Raises:
        DefinitionError, FormulaError: as for `applied`.
    """
    changes = tuple(changes)
    if _typed(changes) or _tabulated(changes) != 1 or _switched(changes):
        return True
    return model.reads_elsewhere(changed_cells(model, _changed(model, changes))[0])


def edits(model: CompiledModel, changes: Iterable[Change]) -> tuple[dict[Cell, CellValue], dict[str, list[str]]]:
    """Say what to type into the workbook, so that it says what the changes say.

    Returns:
        Cell -> what to type, None for nothing; and name of a row -> the columns that its table lacks for it.

    Raises:
        DefinitionError, FormulaError: as for `applied`.
    """
    changes = tuple(changes)
    before = _with_typed(model, changes)
    cells, lacking = changed_cells(before, _changed(before, changes))
    for name, row, used in _switches(model, changes):
        cell = use_cell(model.workbook, row)
        if cell is None:
            lacking.setdefault(name, []).append("Use")
        else:
            cells[cell] = used
    return {**_typed(changes), **cells}, lacking


def _switches(model: CompiledModel, changes: Iterable[Change]) -> Iterator[tuple[str, Cell, bool]]:
    """Name, first cell and state of each row that is to be used, and is not, or the other way round."""
    asked = _switched(changes)
    for name, (row, used) in model.definitions.switches.items():
        if asked.get(name_key(name), used) != used:
            yield name, row, not used


def _typed(changes: Iterable[Change]) -> dict[Cell, CellValue]:
    return {change.cell: change.value for change in changes if isinstance(change, Typed)}


def _with_typed(model: CompiledModel, changes: Sequence[Change]) -> CompiledModel:
    """Make the model with what is typed into cells, switched or tabulated, before any other change."""
    for change in changes:
        _refuse_no_number(change)
        if isinstance(change, Typed):
            _refuse_cell(model, change)
        elif isinstance(change, Switched):
            _refuse_switch(model, change)
    typed, tabulated, switched = _typed(changes), _tabulated(changes), _switched(changes)
    if not typed and tabulated == 1 and not switched:
        return model
    return model_with_values(model, typed, tabulated, switched)


def _tabulated(changes: Iterable[Change]) -> int:
    """Which of its values every `RiskSimtable` gives."""
    return next((change.number for change in changes if isinstance(change, Tabulated)), 1)


def _switched(changes: Iterable[Change]) -> dict[str, bool]:
    """Return filters and evidence that are used, or not, by the keys of their names."""
    return {name_key(change.row): change.used for change in changes if isinstance(change, Switched)}


def _filters_of(model: CompiledModel) -> tuple[Filter, ...]:
    return (*model.filters, *model.forecast_filters)


def changed_cells(model: CompiledModel, definitions: Definitions) -> tuple[dict[Cell, CellValue], dict[str, list[str]]]:
    """Return the cells that would hold something else in a workbook with these definitions.

    Args:
        model: of the workbook as it is.
        definitions: changed ones, with the same rows.

    Returns:
        Cell -> what it would hold; and name of a row -> the columns that its table lacks.
    """
    cells: dict[Cell, CellValue] = {}
    lacking: dict[str, list[str]] = {}
    tables = tables_of(model.workbook)
    for old, new in zip(_rows(model.definitions), _rows(definitions), strict=True):
        if old is not new:
            result, missing = cells_that_change(model.workbook, old, new, tables)
            cells |= result
            if missing:
                lacking[old.name] = missing
    for was, is_now in zip(model.definitions.correlations, definitions.correlations, strict=True):
        if was is not is_now:
            result, missing = cells_that_change(model.workbook, was, is_now, tables)
            cells |= result
            if missing:
                lacking[f"{was.first} and {was.second}"] = missing
    return cells, lacking


def _refuse_no_number(change: Change) -> None:
    """Refuse NaN and infinity, which no cell can hold."""
    values: Iterable[object]
    match change:
        case Frozen():
            what, values = change.assumption, (change.value,)
        case Typed():
            what, values = str(change.cell), (change.value,)
        case Limits():
            what, values = change.filter, change.values.values()
        case Numbers():
            what, values = change.assumption, change.values.values()
        case Measured():
            what, values = change.evidence, change.values.values()
        case Stated():
            what, values = change.forecast, change.values.values()
        case Correlated():
            what, values = change.first, (change.value,)
        case Range():
            what, values = change.assumption, (change.low, change.high)
        case _:
            return
    for value in values:
        if isinstance(value, float) and not math.isfinite(value):
            message = f"{what!r} is changed to {value}, which no cell can hold"
            raise DefinitionError(message, where=change.where, hint="give a number, or None to take a limit away")


def _rows(of: Definitions) -> tuple[Assumption | Filter | Forecast, ...]:
    return (*of.assumptions, *of.filters, *of.forecast_filters, *of.forecasts)


def _refuse_cell(model: CompiledModel, change: Typed) -> None:
    """Refuse a cell of a sheet that is not there, and of the tables that say how all states are run."""
    for table in model.workbook.tables:
        if table.name.casefold().startswith(_OF_ALL) and change.cell in table.area:
            message = f"{change.cell} is a cell of the table {table.name}, which holds for all scenarios alike"
            raise DefinitionError(message, where=change.where, hint="change something else, or run the workbook twice")
    if change.cell.sheet not in model.workbook.sheets:
        message = f"the workbook has no sheet {change.cell.sheet!r}"
        raise DefinitionError(message, where=change.where, hint=did_you_mean(change.cell.sheet, model.workbook.sheets))


def _refuse_switch(model: CompiledModel, change: Switched) -> None:
    """Refuse to switch what is no row of filters or evidence, and evidence without a reading."""
    names = list(model.definitions.switches)
    if name_key(change.row) in map(name_key, names):
        return
    blank = any(name_key(each.name) == name_key(change.row) for each in model.definitions.evidence)
    if blank:
        raise DefinitionError(f"{change.row!r} has no reading", where=change.where, hint="fill in its Reading")
    hint = did_you_mean(change.row, names) if names else "the workbook has none"
    raise DefinitionError(f"there is no filter or evidence {change.row!r}", where=change.where, hint=hint)


def _changed(model: CompiledModel, changes: Iterable[Change]) -> Definitions:
    """Return the definitions with the changes of assumptions and filters."""
    assumptions = {name_key(each.name): each for each in model.assumptions}
    called = {key: each.name for key, each in by_names(model.assumptions).items()}
    filters = {name_key(each.name): each for each in (*model.filters, *model.forecast_filters)}
    forecasts = {name_key(each.name): each for each in model.forecasts}
    unused = {name_key(each.name) for each in model.definitions.unused}
    correlations = list(model.definitions.correlations)
    last: dict[str, Change] = {}
    for change in changes:
        if isinstance(change, Limits):
            if name_key(change.filter) in unused:
                message = f"the filter {change.filter!r} is not used, so that its limits do not matter"
                raise DefinitionError(message, where=change.where, hint="use it in the scenario, too, or leave it out")
            key = _known(change.filter, filters, "filter", change)
            if (evidence := filters[key].evidence) is not None:
                message = f"{evidence.name!r} is evidence: its reading and its error say what it keeps, and no limit"
                hint = "give it another reading or error"
                raise DefinitionError(message, where=change.where or evidence.row, hint=hint)
            filters[key] = replace(filters[key], **change.values)  # type: ignore[arg-type]  # the keys are of limits
            _refuse_contradiction(filters[key], change)
        elif isinstance(change, Measured):
            key = _known(change.evidence, filters, "evidence", change)
            filters[key] = _measured(filters[key], change)
        elif isinstance(change, Stated):
            key = _known(change.forecast, forecasts, "forecast", change)
            forecasts[key] = _stated(forecasts[key], change)
        elif isinstance(change, Correlated):
            _correlate(correlations, change, called)
        elif not isinstance(change, Typed | Switched | Tabulated):
            key = _known(called.get(name_key(change.assumption), change.assumption), assumptions, "assumption", change)
            assumptions[key] = _other(assumptions[key], change, model.lowering)
            last[key] = change
    for key, change in last.items():
        _check(assumptions[key], change)
    count, changed = len(model.filters), tuple(filters.values())
    return replace(
        model.definitions,
        assumptions=tuple(assumptions.values()),
        filters=changed[:count],
        forecast_filters=changed[count:],
        forecasts=tuple(forecasts.values()),
        correlations=tuple(correlations),
    )


def _correlate(correlations: list[Correlation], change: Correlated, called: Mapping[str, str]) -> None:
    """Put the other coefficient in the place of the workbook's.

    Raises:
        DefinitionError: the workbook gives the two none, or it is no coefficient.
    """
    pair = {name_key(called.get(name_key(name), name)) for name in (change.first, change.second)}
    place = next((i for i, c in enumerate(correlations) if {name_key(c.first), name_key(c.second)} == pair), None)
    if place is None:
        message = f"the workbook has no correlation of {change.first!r} and {change.second!r}"
        raise DefinitionError(message, where=change.where, hint="give them one in the workbook; it may be 0")
    if not -1.0 <= change.value <= 1.0:
        message = (
            f"a correlation of {show(change.value)} of {change.first!r} and {change.second!r} must lie between -1 and 1"
        )
        raise DefinitionError(message, where=change.where or correlations[place].row, hint="give a rank correlation")
    correlations[place] = replace(correlations[place], value=change.value)


def _measured(filter_: Filter, change: Measured) -> Filter:
    """Return the filter of a row of evidence with other numbers.

    Raises:
        DefinitionError: it is no evidence, or the numbers are no error of a reading.
    """
    if (evidence := filter_.evidence) is None:
        message = f"{filter_.name!r} is a filter, and has no reading"
        raise DefinitionError(message, where=change.where or filter_.row, hint="change its limits")
    sizes = {key: value for key, value in change.values.items() if key != "reading"}
    wrong = next((key for key in sizes if key not in evidence.sizes), None)
    if wrong is not None:
        message = f"the error of {filter_.name!r} is not given by {SIZES.get(wrong, wrong)}"
        raise DefinitionError(message, where=change.where or filter_.row, hint="change what it is given by")
    result = replace(
        evidence, reading=change.values.get("reading", evidence.reading), sizes={**evidence.sizes, **sizes}
    )
    assert not any(result.cells), "a model knows the numbers of evidence"
    check_sizes(result, result.reading, result.sizes)  # type: ignore[arg-type]  # numbers, as asserted
    return as_filter(result)


def _stated(forecast: Forecast, change: Stated) -> Forecast:
    """Return the forecast with another threshold or central range.

    Raises:
        DefinitionError: the central range is none.
    """
    central = change.values.get("central")
    if central is not None and not 1.0 < central < 100.0:
        message = f"a central range of {show(central)} % of {forecast.name!r} must be above 1 and below 100"
        raise DefinitionError(message, where=change.where or forecast.row, hint="give percent, such as 51")
    share = forecast.central if central is None else central / 100.0
    return replace(forecast, central=share, threshold=change.values.get("threshold", forecast.threshold))


def _merged(again: Definitions, old: Definitions, new: Definitions) -> Definitions:
    """Definitions that were read again from changed cells, with the changes from `old` to `new` that no cell holds."""
    pairs = {a.name: (a, b) for a, b in zip(old.assumptions, new.assumptions, strict=True) if a is not b}
    assumptions = tuple(
        _with_difference(each, *pairs[each.name]) if each.name in pairs else each for each in again.assumptions
    )
    stated = {b.name: b for a, b in zip(old.forecasts, new.forecasts, strict=True) if a is not b}
    forecasts = tuple(
        replace(each, central=by.central, threshold=by.threshold) if (by := stated.get(each.name)) else each
        for each in again.forecasts
    )
    tied = {(b.first, b.second): b for a, b in zip(old.correlations, new.correlations, strict=True) if a is not b}
    correlations = tuple(tied.get((each.first, each.second), each) for each in again.correlations)
    return replace(again, assumptions=assumptions, forecasts=forecasts, correlations=correlations)


def _with_difference(again: Assumption, old: Assumption, new: Assumption) -> Assumption:
    if old.distribution != new.distribution:
        again = replace(new, cell=again.cell, row=again.row, notes=again.notes)
    keys = [*new.given, *old.given]
    numbers = {key: new.given.get(key) for key in keys if old.given.get(key) != new.given.get(key)}
    return replace(again.with_numbers(numbers), frozen=new.frozen, base=new.base)


def _known(
    name: str,
    those: Mapping[str, Assumption] | Mapping[str, Filter] | Mapping[str, Forecast],
    what: str,
    change: Change,
) -> str:
    """Return the key of a name.

    Raises:
        DefinitionError: nothing is called so.
    """
    key = name_key(name)
    if key not in those:
        names = [each.name for each in those.values()]
        hint = did_you_mean(name, names) if names else f"the workbook has no {what}"
        raise DefinitionError(f"there is no {what} {name!r}", where=change.where, hint=hint)
    return key


def _refuse_contradiction(filter_: Filter, change: Limits) -> None:
    limits = {key: getattr(filter_, key) for key in LIMITS}
    pair = contradiction({key: None if isinstance(limit, Cell) else limit for key, limit in limits.items()})
    if pair is not None:
        where = change.where or filter_.row
        raise DefinitionError(f"{filter_.name}: {pair[1]}", where=where, hint="correct one of them")


def _other(assumption: Assumption, change: Change, lowering: Lowering) -> Assumption:
    """Return the assumption with a change."""
    match change:
        case Frozen(_, value):
            base = assumption.base if value is None else value
            if base is None:
                message = f"the assumption {assumption.name!r} has no base value to be held at"
                hint = f"give the value to hold it at, or type one into {assumption.cell}"
                raise DefinitionError(message, where=change.where or assumption.row, hint=hint)
            return replace(assumption, frozen=True, base=base)
        case Drawn():
            return replace(assumption, frozen=False)
        case Range(_, low, high):
            ends = ("low", "high") if {"low", "high"} <= {*assumption.family.keys} else tuple(CUTOFFS)
            given = {key: end for key, end in zip(ends, (low, high), strict=True) if end is not None}
            return assumption.with_numbers(given)
        case Numbers(_, values):
            return assumption.with_numbers(values)
        case Redrawn(_, distribution):
            return _redrawn(assumption, distribution)
        case Band(_, low, high):
            return assumption.with_numbers(_cutoffs(assumption, change, lowering))
    raise TypeError(change)


def _redrawn(assumption: Assumption, to: Distribution) -> Assumption:
    """Return the assumption, drawn from another distribution; its base value, units and source stay where none are
    given.
    """
    return replace(
        assumption,
        distribution=to.family,
        given=to.given,
        base=assumption.base if to.base is None else to.base,
        units=to.units or assumption.units,
        source=to.source or assumption.source,
        frozen=False,
        own_family=None,
        data=None,
        call=None,
        checked=None,
    )


def _cutoffs(assumption: Assumption, band: Band, lowering: Lowering) -> dict[str, float]:
    """Return the cutoffs that leave the band of a distribution; an end at 0 or 100 percent stays as it is."""
    draw = draw_of(assumption, lowering)
    if not draw.fixed:
        message = f"the distribution of {assumption.name!r} depends on other assumptions, and so would its percentiles"
        raise DefinitionError(message, where=band.where or assumption.row, hint="give a range instead, as numbers")
    if not 0 <= band.low < band.high <= 100:
        message = f"a band from P{number_text(band.low)} to P{number_text(band.high)} holds nothing of a distribution"
        raise DefinitionError(message, where=band.where or assumption.row, hint="give two percentiles that rise")
    given = {key: percent for key, percent in zip(CUTOFFS, (band.low, band.high), strict=True) if 0 < percent < 100}
    values = draw.distribution.percentile(np.array([*given.values()]) / 100)
    return dict(zip(given, values.tolist(), strict=True))


def _check(assumption: Assumption, change: Change) -> None:
    """Refuse numbers that are not a distribution, and a distribution for what is not drawn."""
    where = change.where or assumption.row
    if assumption.frozen:
        if isinstance(change, Frozen):
            return
        message = f"{assumption.name!r} is frozen, so that its distribution does not matter"
        raise DefinitionError(message, where=where, hint="let it be drawn in the scenario, too, or leave it out")
    cut = assumption.family.data is not None and not assumption.family.data.truncates
    if cut and assumption.cutoffs:
        hint = "give it other data, or leave it out"
        raise DefinitionError(f"{assumption.name}: {assumption.family.name} cannot be cut off", where=where, hint=hint)
    if assumption.cells:
        return  # the model computes them, and checks what they give
    draw = Draw.of(assumption.name, assumption.family, assumption.given, assumption.stream)
    if (fault := draw.fault()) is not None:
        raise DefinitionError(f"{assumption.name}: {fault.message}", where=where, hint=fault.hint)
