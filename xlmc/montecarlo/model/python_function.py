"""A model whose answers a function of Python computes: a workbook that lists its definitions, and a call in its cells.

The function is called with one array for each assumption, by name, and gives one for each forecast and filter. To all
that follows it is a function of Excel that no file holds: sampling, filters, statistics and studies need nothing else.
"""

from __future__ import annotations

import io
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, Final, TypedDict

import numpy as np
from numpy.typing import ArrayLike, NDArray

from xlmc.errors import DefinitionError, FormulaError
from xlmc.excel.address import Cell
from xlmc.excel.formula import ir
from xlmc.excel.functions.facts import Facts
from xlmc.excel.functions.registry import Anything, Function, Kind
from xlmc.excel.functions.values import Value, unbox_errors
from xlmc.excel.own_functions import numbers_given
from xlmc.excel.workbook.reader import read_workbook
from xlmc.montecarlo.definitions.definitions import CUTOFFS
from xlmc.montecarlo.definitions.definitions_reader import COMPUTED_BY
from xlmc.montecarlo.definitions.distribution import Distribution
from xlmc.montecarlo.definitions.tables.filters import LIMITS
from xlmc.montecarlo.distributions import FAMILIES, family_named
from xlmc.montecarlo.distributions.spelling import name_key
from xlmc.montecarlo.model.loading import build_model
from xlmc.montecarlo.model.model import CompiledModel
from xlmc.montecarlo.number_text import number_text

__all__ = ["FilterColumns", "ForecastColumns", "Vectorised", "function_model"]

Floats = NDArray[np.float64]

Vectorised = Callable[..., Mapping[str, ArrayLike] | ArrayLike]
"""Takes an array `(n,)` for each assumption, by name; gives name -> `(n,)`, or one `(n,)` where one is asked for."""

_SHEET: Final = "Model"
_TRIED: Final = 3
"""Trials that a function is tried with, to see that it takes arrays."""

_NO_FILE: Final = re.compile(r'[\x00-\x1f<>:"/\\|?*]')
"""What no name of a file may have."""

_MADE: Final = datetime(2000, 1, 1, tzinfo=UTC)
"""The time in the file, the same for each, so that the same model is the same file."""


class ForecastColumns(TypedDict, total=False):
    """What is known of a forecast; `range_percent` is 51 where it is left out.

    Attributes:
        units: of its numbers.
        range_percent: how much of the trials its central range holds.
        threshold: P(> threshold) is reported.
        report_to: the resolution at which it is stated, in its units.
        kind: `number`, `yes/no`, `percent`, …
        role: `answer`, `lower bound`, `upper bound` or `diagnostic`.
    """

    units: str
    range_percent: float
    threshold: float
    report_to: float
    kind: str
    role: str


class FilterColumns(TypedDict, total=False):
    """What a filter keeps; without limits its numbers must be 1 (TRUE).

    Attributes:
        at_least, at_most, above, below: the limits.
        because: the evidence.
    """

    at_least: float
    at_most: float
    above: float
    below: float
    because: str


_FORECAST: Final = {
    "units": "Units",
    "range_percent": "Range %",
    "threshold": "Threshold",
    "report_to": "Report to",
    "kind": "Kind",
    "role": "Role",
}
_FILTER: Final = {**LIMITS, "because": "Because"}


@dataclass(frozen=True, slots=True)
class _Body:
    """What the engines call in place of the function: values of the assumptions in, `(n, 1, k)` numbers out.

    Attributes:
        function: the person's.
        label: what messages call it.
        inputs: the names of the assumptions, in order.
        outputs: the `k` names that it must give.
    """

    function: Vectorised
    label: str
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]

    def __call__(self, *values: Value) -> Value:
        """Return the numbers; a NaN or an infinity is #NUM!, and an error of an input that error.

        Raises:
            FormulaError: the function raised an exception, or gives something else than it must.
        """
        n = max(value.shape[0] for value in values)
        read = [value.to_numbers() for value in values]
        columns = {
            name: np.array(np.broadcast_to(numbers, (n,)), np.float64)
            for name, (numbers, _) in zip(self.inputs, read, strict=True)
        }
        result = self.columns(columns, n)
        errors = np.zeros(1, np.uint8)
        for _, codes in read:
            errors = np.where(errors > 0, errors, codes).astype(np.uint8)
        grid = np.stack(result, axis=1)[:, None, :]
        return Value.of_numbers(grid, np.where(errors[:, None, None] > 0, errors[:, None, None], unbox_errors(grid)))

    def columns(self, given: Mapping[str, Floats], n: int) -> list[Floats]:
        """Return what the function gives for `n` trials, `(n,)` for each output.

        Raises:
            FormulaError: it raised an exception, or gives something else than it must.
        """
        try:
            result = self.function(**given)
        except Exception as error:
            hint = f"It is called with an array for each of {', '.join(self.inputs)}, by name"
            message = f"{self.label} failed: {type(error).__name__}: {error}"
            raise FormulaError(message, hint=hint) from error
        if not isinstance(result, Mapping):
            if len(self.outputs) > 1:
                hint = "Return a dict: name -> array"
                raise FormulaError(f"{self.label} must give {', '.join(self.outputs)}", hint=hint)
            result = {self.outputs[0]: result}
        return [self._column(name, result, n) for name in self.outputs]

    def _column(self, name: str, result: Mapping[str, ArrayLike], n: int) -> Floats:
        if name not in result:
            hint = f"It gives {', '.join(map(str, result)) or 'nothing'}"
            raise FormulaError(f"{self.label} does not give {name!r}", hint=hint)
        values = self._numbers(name, result[name])
        if values.shape not in ((), (1,), (n,)):
            hint = "It must take arrays, and give an array of the same length: use numpy.where in place of if"
            message = f"{self.label} gives {name!r} with the shape {values.shape} for {n} trials"
            raise FormulaError(message, hint=hint)
        return np.broadcast_to(values, (n,))

    def _numbers(self, name: str, given: ArrayLike) -> Floats:
        """Return what the function gives as an array of numbers.

        Raises:
            FormulaError: it is something else; see `numbers_given`.
        """
        try:
            return numbers_given(given).astype(np.float64)
        except ValueError as error:
            raise FormulaError(f"{self.label} {error}, as {name!r}", hint="Give numbers or logicals") from error


def function_model(
    function: Vectorised,
    assumptions: Mapping[str, Distribution],
    forecasts: Mapping[str, str | ForecastColumns] | Sequence[str],
    filters: Mapping[str, FilterColumns] | Sequence[str] = (),
    *,
    correlations: Mapping[tuple[str, str], float] | None = None,
    name: str | None = None,
) -> CompiledModel:
    """Make the model of a function; `xlmc.model` describes it.

    Raises:
        DefinitionError: a definition is not what it must be.
        FormulaError: the function fails, does not take arrays, or gives something else than it must.
    """
    answers = _rows(forecasts, "forecast", _FORECAST, "units")
    tests = _rows(filters, "filter", _FILTER, None)
    _refuse_nothing(assumptions, answers)
    called = name or getattr(function, "__name__", type(function).__name__).strip("<>")
    outputs = tuple(dict.fromkeys((*answers, *tests)))
    body = _Body(function, f"The function {called}", tuple(assumptions), outputs)
    bases = {each: _base(each, of) for each, of in assumptions.items()}
    base = _try(body, bases)
    by = f"Python function {getattr(function, '__module__', '')}.{called}"
    data, inputs, cells = _written(assumptions, bases, answers, tests, base, correlations or {}, by)
    row = Function(
        called, (Anything(repeat=True),), body, Kind.NUMBER, facts=Facts(spills=True), home="a function of Python"
    )
    call = ir.Call(f"PYTHON.{called}", inputs, given=row)  # which no pass takes for a function of Excel
    python = {
        cell: ir.Call("INDEX", (call, ir.Number(1.0), ir.Number(1.0 + outputs.index(output))))
        for cell, output in cells.items()
    }
    path = Path(f"{_NO_FILE.sub('_', called)}.xlsx")
    return build_model(read_workbook(data, path.name), path, python=python)


def _rows(
    given: Mapping[str, Any] | Sequence[str], what: str, columns: Mapping[str, str], single: str | None
) -> dict[str, dict[str, Any]]:
    """Name -> key -> value of what is known of each.

    Raises:
        DefinitionError: a key is unknown, or it is no mapping.
    """
    rows: Mapping[str, Any] = given if isinstance(given, Mapping) else {name: {} for name in given}
    result: dict[str, dict[str, Any]] = {}
    for name, row in rows.items():
        if isinstance(row, str) and single:
            row = {single: row}
        if not isinstance(row, Mapping) or not row.keys() <= columns.keys():
            extra = f" {sorted(map(str, row.keys() - columns.keys()))}" if isinstance(row, Mapping) else f" {row!r}"
            hint = f"Give a dict with some of {', '.join(columns)}"
            raise DefinitionError(f"The {what} {name!r} cannot have{extra}", hint=hint)
        result[name] = dict(row)
    return result


def _refuse_nothing(assumptions: Mapping[str, Distribution], forecasts: Mapping[str, object]) -> None:
    for what, rows in (("assumption", assumptions), ("forecast", forecasts)):
        if not rows:
            raise DefinitionError(f"A model needs at least one {what}", hint=f"Name one under {what}s")
    for name, given in assumptions.items():
        if not isinstance(given, Distribution):
            hint = "Give a distribution, such as xlmc.Uniform(0.6, 0.8)"
            raise DefinitionError(f"The assumption {name!r} is {given!r}", hint=hint)
    keys = [name_key(name) for name in assumptions]
    if len(set(keys)) < len(keys):
        raise DefinitionError("Two assumptions differ only in the case of their names", hint="Rename one of them")


def _base(name: str, given: Distribution) -> float:
    """Return the value of the base case: the one given, or the median."""
    if given.base is not None:
        return given.base
    return float(given.draw(name).distribution.percentile(np.array([0.5]))[0])


def _try(body: _Body, bases: Mapping[str, float]) -> dict[str, float]:
    """Compute the outputs at the base case twice, and in several trials at once.

    Raises:
        FormulaError: they differ: the function does not take arrays, or is not the same each time.
    """
    with np.errstate(all="ignore"):
        once = body.columns({name: np.full(1, base) for name, base in bases.items()}, 1)
        again = body.columns({name: np.full(_TRIED, base) for name, base in bases.items()}, _TRIED)
    for name, first, rest in zip(body.outputs, once, again, strict=True):
        if not np.allclose(rest, first[0], rtol=1e-9, atol=0.0, equal_nan=True):
            message = (
                f"{body.label} gives {name!r} as {number_text(first[0])}, then as {rest.tolist()}, for the same values"
            )
            hint = "It must compute each trial from that trial's values alone, and draw nothing at random itself"
            raise FormulaError(message, hint=hint)
    return {name: float(first[0]) for name, first in zip(body.outputs, once, strict=True)}


def _written(
    assumptions: Mapping[str, Distribution],
    bases: Mapping[str, float],
    forecasts: Mapping[str, Mapping[str, Any]],
    filters: Mapping[str, Mapping[str, Any]],
    base: Mapping[str, float],
    correlations: Mapping[tuple[str, str], float],
    by: str,
) -> tuple[bytes, tuple[Cell, ...], dict[Cell, str]]:
    """Make the workbook that lists the definitions.

    Returns:
        Its bytes, the cells of the assumptions, and cell of a forecast or filter -> its name.
    """
    import xlsxwriter

    families = [family_named(each.family) for each in assumptions.values()]
    families += [each for each in FAMILIES.values() if each.data is None]  # from which it may be drawn in a change
    specs = {spec.heading: spec.key for family in families for spec in family.parameters}
    specs |= {heading: key for key, heading in CUTOFFS.items()}
    drawn = [
        {
            "Name": name,
            "Value": bases[name],
            "Units": each.units,
            "Distribution": each.family,
            **{heading: each.given.get(key) for heading, key in specs.items()},
            "Source": each.source,
            "Frozen": None,
        }
        for name, each in assumptions.items()
    ]
    answers = [
        {"Name": name, "Value": base[name], **_headed(row, _FORECAST), COMPUTED_BY: by}
        for name, row in forecasts.items()
    ]
    tests = [
        {"Name": name, "Value": base[name], **_headed(row, _FILTER), COMPUTED_BY: by, "Use": None}
        for name, row in filters.items()
    ]
    pairs = [{"First": a, "Second": b, "Correlation": value} for (a, b), value in correlations.items()]
    stream = io.BytesIO()
    book = xlsxwriter.Workbook(stream, {"in_memory": True, "strings_to_formulas": False, "strings_to_urls": False})
    book.set_properties({"created": _MADE})
    sheet = book.add_worksheet(_SHEET)
    sheet.set_column(0, 0, 36)
    sheet.set_column(1, 20, 14)
    sheet.write_string(
        0, 0, f"Computed by the {by}, which this workbook does not hold", book.add_format({"bold": True})
    )
    top, shown, last = 2, 0, 0
    places: list[list[Cell]] = []
    for kind, rows in (
        ("xlmc_assumptions", drawn),
        ("xlmc_forecasts", answers),
        ("xlmc_filters", tests),
        ("xlmc_correlations", pairs),
    ):
        places.append([Cell(_SHEET, top + 2 + number, 2) for number in range(len(rows))])
        if not rows:
            continue
        filled = [heading for heading in rows[0] if any(row[heading] not in (None, "") for row in rows)]
        headings = [*filled, *(heading for heading in rows[0] if heading not in filled)]  # which changes fill
        shown, last = max(shown, len(filled)), max(last, len(headings))
        for number, row in enumerate(rows, start=top + 1):
            for column, heading in enumerate(headings):
                _write(sheet, number, column, row[heading])
        table = {"name": kind, "columns": [{"header": heading} for heading in headings], "autofilter": False}
        sheet.add_table(top, 0, top + len(rows), len(headings) - 1, table)
        top += len(rows) + 3
    sheet.set_column(shown, last, 14, None, {"hidden": True})
    book.close()
    named = {**dict(zip(places[1], forecasts, strict=True)), **dict(zip(places[2], filters, strict=True))}
    return stream.getvalue(), tuple(places[0]), named


def _headed(row: Mapping[str, Any], headings: Mapping[str, str]) -> dict[str, Any]:
    return {heading: row.get(key) for key, heading in headings.items()}


def _write(sheet: Any, row: int, column: int, value: object) -> None:
    """Write a number or a text; nothing for what has no number."""
    if isinstance(value, str):
        sheet.write_string(row, column, value)
    elif value is not None and np.isfinite(number := float(value)):  # type: ignore[arg-type]
        sheet.write_number(row, column, number)
