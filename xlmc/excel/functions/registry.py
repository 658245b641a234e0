"""One row per Excel function: what it takes, what it gives, and one small pure body.

A body of *element* arguments (`Number`, `Logical`, `Text`) gets arrays that broadcast, trials first, and returns one
array; it sees no errors, and puts its own into the result (see `values.NUM`). A body of *set* arguments (`Numbers`,
`Logicals`) gets all of its arguments flattened to one `(n, k)` array, and a mask of the cells that count. A body with
an `Anything` or `Cells` argument gets `Value`s, and handles kinds and errors itself; only sets and `Cells` take ranges.
Of a function that has no formula for arrays, such as most of texts, write the body for one trial, and `@per_element`
above it, `@per_object` if an argument is `Anything` (`excel/functions/per_element.py`). `returns` says what the result
is, if it is no number: `returns=Kind.TEXT`.

A row with a `ufunc` promises that the ufunc alone gives the body's values wherever no floating-point flag is raised and
`guard` holds. That is what the fast engine runs.

To add a function, write its body below `@excel("NAME", …)` in a file of the folder of its category: all files below
`xlmc/excel/functions` are imported, and no other is edited. The parameters say what the body gets; one that gives many
cells takes `Anything`, `Cells` or `Arrays`, and its row says `facts=Facts(spills=True)`: `array_function`, in
`excel/functions/arrays`, writes that row. Whatever else is known of the function goes into `facts`; the class `Facts`
describes each fact, and what is assumed while it is not stated. Then the engines `numpy` and `jit` compute the
function, its derivatives are taken by differences, and `xlmc stability`, which computes cells again with 50 digits,
says that it could not do so with this function. Where that is not enough, give the function a row in
`engine/llvm/operations`, `engine/passes/derivatives` or `engine/passes/exact`. Test it in the folder of
`tests/excel/functions` with the same name, and write the list of functions anew: `python docs/list_functions.py`.
docs/adding.md has an example of each.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, fields, replace
from enum import Enum
from functools import cache
from importlib import import_module
from math import prod
from typing import Any, Final, Protocol

import numpy as np
from numpy.typing import NDArray

from xlmc.errors import FormulaError
from xlmc.excel.functions.arguments import first_error_in_row, with_errors
from xlmc.excel.functions.budget import ask_for_cells
from xlmc.excel.functions.facts import NOTHING, Facts
from xlmc.excel.functions.lookup.picked_cells import flatten_cells, join_cells
from xlmc.excel.functions.number_text import dates_from_1904
from xlmc.excel.functions.values import ERROR, LOGICAL, NUMBER, Bools, Codes, Value, from_objects

__all__ = [
    "REGISTRY",
    "Anything",
    "Arrays",
    "Cells",
    "Elementwise",
    "Function",
    "Kind",
    "Logical",
    "Logicals",
    "Number",
    "Numbers",
    "Parameter",
    "Ranges",
    "Text",
    "excel",
    "from_1904",
    "function_named",
    "row_of",
    "side_by_side",
]


class Kind(Enum):
    """What an argument is taken as, or a result is."""

    NUMBER = "number"
    LOGICAL = "logical"
    TEXT = "text"
    ANY = "any"

    __hash__ = object.__hash__  # kinds are looked up in dicts for every node


class Called(Protocol):
    """An object that is called like a NumPy ufunc."""

    @property
    def nin(self) -> int: ...

    def __call__(self, *args: Any, **kwargs: Any) -> Any: ...


Elementwise = np.ufunc | Called


class _Required(Enum):
    REQUIRED = "required"


_REQUIRED: Final = _Required.REQUIRED


class Ranges(Enum):
    """How an expression that is an argument takes ranges, in a formula that is no array formula.

    `ONE_CELL` holds in array formulas, too. Excel keeps this for each argument of each function: its file format has
    three classes, reference, value and array.
    """

    AROUND = "as the expression around the call: cell by cell within SUMPRODUCT, else the cell beside the formula"
    CELLS = "cell by cell: as in an array formula"
    BESIDE = "the cell beside the formula, even within SUMPRODUCT; a range that is the whole argument stays a range"
    SINGLE = "the cell beside the formula, even within SUMPRODUCT, and even of a range that is the whole argument"
    ONE_CELL = "as the expression around the call; a range of several cells that is the whole argument is #VALUE!"

    __hash__ = object.__hash__


@dataclass(frozen=True, slots=True)
class Parameter:
    """One argument of a function; call it to give a default or to let it repeat: `Number(default=0)`.

    Attributes:
        as_set: all arguments of the function are flattened to one set.
        ranged: it takes a whole range; any other argument takes the cell of the range beside the formula.
        ranges: how an expression there takes ranges; in array formulas only `ONE_CELL` makes a difference.
    """

    kind: Kind
    default: object = _REQUIRED
    repeat: bool = False
    as_set: bool = False
    ranged: bool = False
    ranges: Ranges = Ranges.AROUND

    def __call__(self, *, default: object = _REQUIRED, repeat: bool = False, ranges: Ranges | None = None) -> Parameter:
        return replace(self, default=default, repeat=repeat, ranges=ranges or self.ranges)

    @property
    def required(self) -> bool:
        return self.default is _REQUIRED


Number: Final = Parameter(Kind.NUMBER)
Logical: Final = Parameter(Kind.LOGICAL)
Text: Final = Parameter(Kind.TEXT)
Anything: Final = Parameter(Kind.ANY)
Cells: Final = Parameter(Kind.ANY, ranged=True)
Arrays: Final = Parameter(Kind.ANY, ranged=True, ranges=Ranges.CELLS)
Numbers: Final = Parameter(Kind.NUMBER, repeat=True, as_set=True, ranged=True)
Logicals: Final = Parameter(Kind.LOGICAL, repeat=True, as_set=True, ranged=True)


@dataclass(frozen=True, slots=True, eq=False)
class Function:
    """A registry row.

    Attributes:
        ufunc: see the module; with set arguments it folds them from left to right.
        guard: takes the body's float arrays and returns whether `ufunc` and Excel agree for all of them.
        volatile: its value may change though its arguments do not.
        dated: the body takes the keyword `date1904`: whether serial dates count from 1904.
        macintosh: the body takes the keyword `macintosh`: whether Excel for the Macintosh made the book.
        facts: what else is known of it.
        home: the module that registers it.
        takes_values, takes_sets: whether any argument is of `ANY` kind, or all are one set.
        on_numbers: if all arguments are numbers, the ufunc may replace the body.
        fast_arity: how many arguments that ufunc takes, one or two; 0 without one, or if it takes more.
    """

    name: str
    parameters: tuple[Parameter, ...]
    body: Callable[..., Any]
    returns: Kind
    ufunc: Elementwise | None = None
    guard: Callable[..., bool] | None = None
    volatile: bool = False
    dated: bool = False
    macintosh: bool = False
    facts: Facts = NOTHING
    home: str = ""
    takes_values: bool = field(init=False)
    takes_sets: bool = field(init=False)
    on_numbers: bool = field(init=False)
    fast_arity: int = field(init=False)

    def __post_init__(self) -> None:
        """Compute the last four attributes, which are read for every node.

        Raises:
            ValueError: it spills, but its body does not get `Value`s, and so cannot see what to spill.
        """
        values = any(parameter.kind is Kind.ANY for parameter in self.parameters)
        sets = any(parameter.as_set for parameter in self.parameters)
        kinds = {parameter.kind for parameter in self.parameters}
        numbers = self.ufunc is not None and not sets and kinds <= {Kind.NUMBER, Kind.ANY}
        fast = self.ufunc.nin if numbers and self.ufunc is not None and self.ufunc.nin < 3 else 0
        answers = {"takes_values": values, "takes_sets": sets, "on_numbers": numbers, "fast_arity": fast}
        for name, value in answers.items():
            object.__setattr__(self, name, value)
        if self.facts.spills and (self.ufunc is not None or (self.parameters and not values)):
            raise ValueError(f"{self.name} spills: it takes `Anything`, `Cells` or `Arrays`, and has no ufunc")

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle a row of the registry by its name, and any other function, made for a workbook, with all its parts."""
        if REGISTRY.get(self.name) is self:
            return row_of, (self.name, self.home)
        options = self.volatile, self.dated, self.macintosh, self.facts
        return Function, (self.name, self.parameters, self.body, self.returns, self.ufunc, self.guard, *options)

    def parameter(self, position: int) -> Parameter:
        """Return the parameter of an argument; those that may repeat follow each other in turn."""
        if position < len(self.parameters):
            return self.parameters[position]
        cycle = [p for p in self.parameters if p.repeat]
        return cycle[(position - len(self.parameters)) % len(cycle)]

    def arity(self) -> tuple[int, int]:
        """Return the fewest and the most arguments that it takes."""
        fewest = sum(1 for p in self.parameters if p.required)
        return fewest, 255 if any(p.repeat for p in self.parameters) else len(self.parameters)

    def __call__(self, arguments: Sequence[Value]) -> Value:
        """Compute the function as Excel does, errors trial by trial; arguments left out take their defaults."""
        if any(argument.numbers.ndim == 3 for argument in arguments):
            self._ask_for(arguments)
        with np.errstate(all="ignore"):
            if self.takes_values:
                return _as_value(self.body(*arguments), self.returns, None)
            if self.takes_sets:
                return self._of_sets(arguments)
            return self._of_elements(arguments)

    def check_spill(self, result: Value, arguments: Sequence[Value]) -> Value:
        """Return the result, which may be many cells only if it spills or an argument for a single value is many.

        Raises:
            FormulaError: neither is so.
        """
        if result.numbers.ndim < 3 or self.facts.spills:
            return result
        if any(a.numbers.ndim == 3 and not self.parameter(i).ranged for i, a in enumerate(arguments)):
            return result
        raise self.spill_error()

    def spill_error(self) -> FormulaError:
        """Make the error for a function that gives many cells though its row does not say that it spills."""
        hint = "write `facts=Facts(spills=True)` into its row in xlmc/excel/functions"
        return FormulaError(f"{self.name} gives many cells, which its row in the registry does not say", hint=hint)

    def _ask_for(self, arguments: Sequence[Value]) -> None:
        """Ask for the array that single arguments broadcast to, and for that of all cells put side by side."""
        shapes = [argument.shape for argument in arguments]
        n = max(shape[0] for shape in shapes)
        parameters = [self.parameter(position) for position in range(len(arguments))]
        single = [s for s, p in zip(shapes, parameters, strict=True) if not p.ranged and len(s) == 3]
        if single:
            ask_for_cells(n, max(s[1] for s in single), max(s[2] for s in single))
        joined = [s for s, p in zip(shapes, parameters, strict=True) if p.ranged and p.repeat]
        ask_for_cells(n, sum(prod(s[1:]) for s in joined))

    def _of_elements(self, arguments: Sequence[Value]) -> Value:
        if any(argument.numbers.ndim == 3 for argument in arguments):
            arguments = [argument.as_range() for argument in arguments]
        arrays: list[Any] = []
        errors = np.zeros(1, np.uint8)
        known: dict[tuple[int, Kind], tuple[NDArray[Any], Codes]] = {}  # `x&x` reads x as a text once
        for position, argument in enumerate(arguments):
            key = id(argument), self.parameter(position).kind
            if key not in known:
                known[key] = _coerce(argument, key[1])
            array, values = known[key]
            arrays.append(array)
            if values.size != 1 or values.item():  # one that is none changes nothing
                errors = np.where(errors > 0, errors, values).astype(np.uint8, copy=False)
        if errors.all():  # else the body would compute, text by text at worst, results that the errors replace
            shape = np.broadcast_shapes(errors.shape, *(array.shape for array in arrays))
            return Value.of_errors(np.broadcast_to(errors, shape))
        arrays += [p.default for p in self.parameters[len(arguments) :] if not p.repeat]
        return _as_value(self.body(*arrays), self.returns, errors if errors.any() else None)

    def _of_sets(self, arguments: Sequence[Value]) -> Value:
        kind = self.parameters[0].kind
        x, counts, errors = side_by_side(arguments, kind)
        return _as_value(self.body(x, counts), self.returns, errors if errors.any() else None)


@dataclass(frozen=True, slots=True, eq=False)
class _From1904(Function):
    """A function that reads texts that are dates as days from 1904 on."""

    row: Function = field(kw_only=True)

    def __reduce__(self) -> tuple[Any, ...]:
        return from_1904, (self.row,)

    def __call__(self, arguments: Sequence[Value]) -> Value:
        with dates_from_1904():
            return self.row(arguments)


@cache
def from_1904(row: Function) -> Function:
    """Return the function as workbooks have it whose dates count from 1904; the same object each time."""
    given = {each.name: getattr(row, each.name) for each in fields(row) if each.init}
    return _From1904(**given, row=row)


def _coerce(value: Value, kind: Kind) -> tuple[NDArray[Any], Codes]:
    if kind is Kind.NUMBER:
        return value.to_numbers()
    return value.to_logicals() if kind is Kind.LOGICAL else value.to_texts()


def _as_value(result: Any, returns: Kind, errors: Codes | None) -> Value:
    if isinstance(result, Value):
        return result if errors is None else _put_errors_over(result, errors)
    array = np.atleast_1d(np.asarray(result))
    if errors is not None and array.ndim > errors.ndim:
        errors = errors[:, None, None]
    if errors is not None:
        array = np.broadcast_to(array, np.broadcast_shapes(array.shape, errors.shape))
    if array.dtype == object:
        value = from_objects(array)
        return value if errors is None else _put_errors_over(value, errors)
    if returns is Kind.LOGICAL:
        return Value.of_logicals(array.astype(bool), errors)
    return Value.of_numbers(array.astype(np.float64, copy=False), errors)


def _put_errors_over(value: Value, errors: Codes) -> Value:
    """Put the errors of arguments in place of whatever the body computed in those trials."""
    return with_errors(value, errors[:, None, None] if value.numbers.ndim > errors.ndim else errors)


def side_by_side(arguments: Sequence[Value], kind: Kind) -> tuple[NDArray[Any], Bools, Codes]:
    """Put all arguments side by side, `(n, k)`: the values, which of them count, and the first error of each trial.

    A value given directly is converted; a cell of a range (n, r, c) counts only if it is of the kind itself.
    """
    columns, counted, errors = [], [], []
    for argument in arguments:
        in_range = argument.numbers.ndim == 3
        x, values = (argument.numbers, argument.errors) if in_range else _coerce(argument, kind)
        wanted = (argument.kinds == NUMBER) if kind is Kind.NUMBER else (argument.kinds <= LOGICAL)
        counts = (wanted if in_range else argument.kinds < ERROR) & (values == 0)
        columns.append(flatten_cells(x, argument))
        counted.append(flatten_cells(counts, argument))
        errors.append(flatten_cells(values, argument))
    x, counts, values = (join_cells(part) for part in (columns, counted, errors))
    return (x if kind is Kind.NUMBER else x != 0), counts, first_error_in_row(values)


REGISTRY: Final[dict[str, Function]] = {}

_FAMILIES: Final = "xlmc.excel.functions.families"
"""The module that imports all functions."""


def excel(
    name: str,
    *parameters: Parameter,
    returns: Kind = Kind.NUMBER,
    aliases: tuple[str, ...] = (),
    ufunc: Elementwise | None = None,
    guard: Callable[..., bool] | None = None,
    volatile: bool = False,
    dated: bool = False,
    macintosh: bool = False,
    facts: Facts = NOTHING,
) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """Register a body as the Excel function `name`."""
    home = str(sys._getframe(1).f_globals["__name__"])  # a body may be NumPy's, which does not know its module

    def register(body: Callable[..., Any]) -> Callable[..., Any]:
        row = Function(name, parameters, body, returns, ufunc, guard, volatile, dated, macintosh, facts, home)
        for key in (name, *aliases):
            if key in REGISTRY:
                raise ValueError(f"{key} is registered twice, in {REGISTRY[key].home} and in {home}")
            REGISTRY[key] = row
        return body

    return register


def function_named(name: str) -> Function | None:
    """Return the row of an Excel function, its name in capitals and without `_xlfn.`; None if there is none."""
    return REGISTRY.get(name)


def row_of(name: str, module: str = _FAMILIES) -> Function:
    """Return the row of a name that has one, and import its module first if need be.

    Args:
        name: in capitals.
        module: the module that is likely to register it.
    """
    for home in (module, _FAMILIES):
        if name not in REGISTRY:
            import_module(home)
    return REGISTRY[name]
