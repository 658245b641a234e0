"""What differs between a workbook as it was and as it was saved now, in phrases: `friction: High 0.75 → 0.85`."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, Final, Protocol, TypeVar

from xlmc.analysis.results.statements.in_words import distribution_text, given_text, limits_text
from xlmc.excel.address import Cell
from xlmc.montecarlo.definitions.definitions import Filter
from xlmc.montecarlo.number_text import count_text, styled_text
from xlmc.outputs.live.adjustments import LIMITS, SOLVED, assumption_numbers

if TYPE_CHECKING:
    from xlmc.montecarlo.definitions.definitions import Assumption, Decision, Forecast, Parameter, Solve
    from xlmc.montecarlo.model.model import CompiledModel

__all__ = ["what_changed"]

_MOST_CELLS: Final = 4

Row = TypeVar("Row", bound="_HasName")


def what_changed(before: CompiledModel, after: CompiledModel) -> list[str]:
    """Return phrases, those on assumptions first; none if nothing that a run depends on has changed."""
    result = [
        *_rows("assumption", _named(before.assumptions), _named(after.assumptions), _assumption),
        *_rows("filter", _filters(before), _filters(after), _filter),
        *_rows("forecast", _named(before.forecasts), _named(after.forecasts), _forecast),
        *_names("check", _named(before.checks), _named(after.checks)),
        *_rows("decision", _named(before.definitions.decisions), _named(after.definitions.decisions), _decision),
        *_rows("solved cell", _named(before.definitions.solves), _named(after.definitions.solves), _solve),
        *_correlations(before, after),
        *_settings(before, after),
    ]
    return [*result, *_cells(before, after)]


class _HasName(Protocol):
    @property
    def name(self) -> str: ...


def _named(rows: Iterable[Row]) -> dict[str, Row]:
    return {each.name: each for each in rows}


def _filters(model: CompiledModel) -> dict[str, Filter]:
    """Return all filters and evidence by name, those that are not used among them."""
    definitions = model.definitions
    idle = (
        Filter(each.name, each.cell, each.row, evidence=each, used=False)
        for each in definitions.evidence
        if not each.used
    )
    return _named((*definitions.filters, *definitions.forecast_filters, *definitions.unused, *idle))


def _names(what: str, before: Iterable[str], after: Iterable[str]) -> Iterator[str]:
    old, new = list(before), list(after)
    yield from (f"new {what} {name}" for name in new if name not in old)
    yield from (f"{what} {name} is gone" for name in old if name not in new)


def _rows(
    what: str, before: Mapping[str, Row], after: Mapping[str, Row], differing: Callable[[Row, Row], Iterator[str]]
) -> Iterator[str]:
    """Say what changed in rows with names: those that are still there, those that are new, and those that are gone."""
    for name, row in after.items():
        phrases = list(differing(before[name], row)) if name in before else []
        if phrases:
            yield f"{name}: {', '.join(phrases)}"
    yield from _names(what, before, after)


def _assumption(before: Assumption, after: Assumption) -> Iterator[str]:
    old, new = assumption_numbers(before), assumption_numbers(after)
    if before.distribution != after.distribution or old.keys() != new.keys() or before.data != after.data:
        yield f"{distribution_text(before)} → {distribution_text(after)}"
    else:
        for key, (heading, value) in new.items():
            if value != old[key][1]:
                yield f"{heading} {_number(before, key, old[key][1])} → {_number(after, key, value)}"
    if before.frozen != after.frozen:
        yield "frozen" if after.frozen else "not frozen"
    if before.base != after.base:
        values = ["blank" if each.base is None else _number(each, "low", each.base) for each in (before, after)]
        yield f"value {values[0]} → {values[1]}"


def _number(assumption: Assumption, key: str, value: Parameter) -> str:
    """Write a number of an assumption as its cell shows it; the cell of one that a formula computes."""
    return given_text(value) if isinstance(value, Cell) else assumption.form_of(key, value).number(value)


def _filter(before: Filter, after: Filter) -> Iterator[str]:
    if before.used != after.used:
        yield "used" if after.used else "not used"
    elif any(getattr(before, key) != getattr(after, key) for key in LIMITS) or _measured(before) != _measured(after):
        yield f"{limits_text(before)} → {limits_text(after)}"


def _measured(filter_: Filter) -> object:
    """Return what a row of evidence says was measured; otherwise None."""
    evidence = filter_.evidence
    return None if evidence is None else (evidence.error, evidence.reading, evidence.sizes)


def _forecast(before: Forecast, after: Forecast) -> Iterator[str]:
    if before.threshold != after.threshold:
        values = [
            "none" if each.threshold is None else given_text(each.threshold, each.form) for each in (before, after)
        ]
        yield f"threshold {values[0]} → {values[1]}"
    if before.central != after.central:
        yield (
            f"central range {styled_text(100.0 * before.central, '.12g')} % → "
            f"{styled_text(100.0 * after.central, '.12g')} %"
        )


def _decision(before: Decision, after: Decision) -> Iterator[str]:
    if before.base != after.base:
        values = ["none" if each.base is None else each.shown(each.base) for each in (before, after)]
        yield f"value {values[0]} → {values[1]}"
    if (before.values, before.contents) != (after.values, after.contents):
        yield f"tried: {before.values_text} → {after.values_text}"


def _solve(before: Solve, after: Solve) -> Iterator[str]:
    for key, heading in SOLVED.items():
        old, new = getattr(before, key), getattr(after, key)
        if old != new:
            yield f"{heading} {given_text(old, before.form_of(key))} → {given_text(new, after.form_of(key))}"
    if (before.by, before.cell, before.root) != (after.by, after.cell, after.root):
        yield "another cell is solved for, or another value is taken"


def _correlations(before: CompiledModel, after: CompiledModel) -> Iterator[str]:
    old, new = (
        {(row.first, row.second): row.value for row in model.definitions.correlations} for model in (before, after)
    )
    for pair in dict.fromkeys([*old, *new]):
        values = [given_text(rows[pair]) if pair in rows else "none" for rows in (old, new)]
        if values[0] != values[1]:
            yield f"correlation of {pair[0]} with {pair[1]} {values[0]} → {values[1]}"


def _settings(before: CompiledModel, after: CompiledModel) -> Iterator[str]:
    old, new = before.definitions.settings, after.definitions.settings
    for name in ("trials", "seed", "sampling", "engine"):
        first, second = getattr(old, name), getattr(new, name)
        if first != second:
            yield f"{name} {first} → {second}"
    if old.stopping != new.stopping:
        yield "when a run ends"


def _cells(before: CompiledModel, after: CompiledModel) -> Iterator[str]:
    """Name the needed cells that hold another formula or number; not of assumptions and decisions."""
    explained = {each.cell for model in (before, after) for each in model.assumptions}
    explained |= {each.cell for model in (before, after) for each in model.definitions.decisions}
    explained |= {
        cell for model in (before, after) for each in model.definitions.solves for cell in each.typed.values()
    }
    cells = [
        cell
        for cell in sorted((before.read | after.read) - explained)
        if _content(before, cell) != _content(after, cell)
    ]
    if cells:
        named = ", ".join(map(str, cells[:_MOST_CELLS]))
        more = f" and {count_text(len(cells) - _MOST_CELLS)} more" if len(cells) > _MOST_CELLS else ""
        yield f"{named}{more} changed"


def _content(model: CompiledModel, cell: object) -> object:
    """Return the formula, if there is one: its saved value may differ because an assumption's does."""
    content = model.workbook.content(cell)  # type: ignore[arg-type]  # a cell
    return content.formula or content.value
