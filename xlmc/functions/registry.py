"""One row per Excel function: what it takes, what it gives, and one small pure body.

A body of *element* arguments (`Number`, `Logical`, `Text`) gets arrays that broadcast, trials first, and returns one
array; it knows nothing of errors but those it makes itself (see `values.NUM` and its like). A body of *set* arguments
(`Numbers`, `Logicals`) gets all of its arguments flattened to one `(n, k)` array and a mask of what counts. A body with
an `Anything` or `Cells` argument gets `Value`s and minds kinds and errors itself; only sets and `Cells` take ranges.

A row with a `ufunc` promises: where no floating-point flag is raised and `guard` holds, the ufunc alone gives the
body's values. That is what the fast engine runs.

To add a function, write its body below `@excel("NAME", …)` in a file of the folder of its category: all files below
`xlmc/functions` are imported, and no other is edited. The parameters say what the body gets; one that gives many cells
takes `Anything`, `Cells` or `Arrays`, and its row says `facts=Facts(spills=True)`: `array_function`, in
`functions/arrays`, writes that row. Whatever else is known of the function goes into `facts`, where each fact is
described, with what is assumed while it is not stated. The engines `numpy` and `jit` then compute it, derivatives are
taken by differences, and `xlmc stability`, where it computes a cell again with 50 digits, says that it could not do so
with this function. Where that is not enough, give the function a row in `evaluation/llvm/operations`,
`evaluation/passes/derivatives` or `evaluation/passes/exact`. Test it in the folder of `tests/functions` of the same
name, and write the list of functions anew: `python docs/list_functions.py`. docs/adding.md has an example of each.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from enum import Enum
from importlib import import_module
from math import prod
from typing import Any, Final, Protocol

import numpy as np
from numpy.typing import NDArray

from xlmc.errors import FormulaError
from xlmc.functions.budget import ask_for_cells
from xlmc.functions.facts import NOTHING, Facts
from xlmc.functions.values import ERROR, LOGICAL, NUMBER, Bools, Codes, Value, from_objects

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
    "function_named",
    "row_of",
]


class Kind(Enum):
    """What an argument is taken as, or a result is."""

    NUMBER = "number"
    LOGICAL = "logical"
    TEXT = "text"
    ANY = "any"

    __hash__ = object.__hash__  # kinds are looked up in dicts for every node


class Called(Protocol):
    """What is called as a NumPy ufunc is."""

    @property
    def nin(self) -> int: ...

    def __call__(self, *args: Any, **kwargs: Any) -> Any: ...


Elementwise = np.ufunc | Called


class _Required(Enum):
    REQUIRED = "required"


_REQUIRED: Final = _Required.REQUIRED


class Ranges(Enum):
    """How what is computed in an argument takes its ranges, in a formula that is no array formula.

    `ONE_CELL` holds in array formulas, too. Excel keeps this for each argument of each function, as a class of its own
    file format: reference, value or array.
    """

    AROUND = "as what stands around the call: cell by cell within SUMPRODUCT, else the cell beside the formula"
    CELLS = "cell by cell: as in an array formula"
    BESIDE = "the cell beside the formula, even within SUMPRODUCT; a range that is all of the argument stays whole"
    SINGLE = "the cell beside the formula, even within SUMPRODUCT, and even of a range that is all of the argument"
    ONE_CELL = "as what stands around the call; a range of several cells that is all of the argument is #VALUE!"

    __hash__ = object.__hash__


@dataclass(frozen=True, slots=True)
class Parameter:
    """One argument of a function; call it to give a default or to let it repeat: `Number(default=0)`.

    Attributes:
        as_set: it and all others are flattened to one set.
        ranged: it takes a range whole; any other argument takes the cell of the range beside the formula.
        ranges: how what is computed there takes ranges; but for `ONE_CELL` it makes no difference in array formulas.
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
        guard: takes the body's float arrays, says whether all of them lie where `ufunc` and Excel agree.
        volatile: its value changes without its arguments.
        dated: the body takes `date1904`, keyword only: whether serial dates count from 1904.
        macintosh: the body takes `macintosh`, keyword only: whether the book was made by Excel for the Macintosh.
        facts: what else is known of it.
        home: the module that registers it.
        takes_values, takes_sets: whether any argument is of `ANY` kind, or all are one set.
        on_numbers: with arguments that are all numbers, the ufunc alone may be run.
        fast_arity: how many arguments that ufunc takes, one or two; 0 where there is none or it takes more.
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
        """Answer once what is asked of every node.

        Raises:
            ValueError: it spills, and its body does not get the values to see what to spill.
        """
        values = any(parameter.kind is Kind.ANY for parameter in self.parameters)
        sets = any(parameter.as_set for parameter in self.parameters)
        kinds = {parameter.kind for parameter in self.parameters}
        numbers = self.ufunc is not None and not sets and kinds <= {Kind.NUMBER, Kind.ANY}
        fast = self.ufunc.nin if numbers and self.ufunc is not None and self.ufunc.nin < 3 else 0
        answers = {"takes_values": values, "takes_sets": sets, "on_numbers": numbers, "fast_arity": fast}
        for name, found in answers.items():
            object.__setattr__(self, name, found)
        if self.facts.spills and (self.ufunc is not None or (self.parameters and not values)):
            raise ValueError(f"{self.name} spills: it takes `Anything`, `Cells` or `Arrays`, and has no ufunc")

    def __reduce__(self) -> tuple[Any, ...]:
        """A row goes to another process by its name, where it is looked up; one that was made for a workbook whole."""
        if REGISTRY.get(self.name) is self:
            return row_of, (self.name, self.home)
        options = self.volatile, self.dated, self.macintosh, self.facts
        return Function, (self.name, self.parameters, self.body, self.returns, self.ufunc, self.guard, *options)

    def parameter(self, position: int) -> Parameter:
        """The parameter of an argument; the last ones repeat where they may."""
        if position < len(self.parameters):
            return self.parameters[position]
        cycle = [p for p in self.parameters if p.repeat]
        return cycle[(position - len(self.parameters)) % len(cycle)]

    def arity(self) -> tuple[int, int]:
        """The fewest and the most arguments it takes."""
        fewest = sum(1 for p in self.parameters if p.required)
        return fewest, 255 if any(p.repeat for p in self.parameters) else len(self.parameters)

    def __call__(self, arguments: Sequence[Value]) -> Value:
        """The function of Excel: any values in, values out, errors kept per trial. Absent arguments are filled in."""
        if any(argument.numbers.ndim == 3 for argument in arguments):
            self._ask_for(arguments)
        with np.errstate(all="ignore"):
            if self.takes_values:
                return _as_value(self.body(*arguments), self.returns, None)
            if self.takes_sets:
                return self._of_sets(arguments)
            return self._of_elements(arguments)

    def checked(self, result: Value, arguments: Sequence[Value]) -> Value:
        """The result, of which many cells come only of arguments of single values that are many.

        Raises:
            FormulaError: none of them is, and the row does not say that the function spills.
        """
        if result.numbers.ndim < 3 or self.facts.spills:
            return result
        if any(a.numbers.ndim == 3 and not self.parameter(i).ranged for i, a in enumerate(arguments)):
            return result
        raise self.not_single()

    def not_single(self) -> FormulaError:
        """What is said where it gives many cells for single ones, against what its row says."""
        hint = "write `facts=Facts(spills=True)` into its row in xlmc/functions"
        return FormulaError(f"{self.name} gives many cells, which its row in the registry does not say", hint=hint)

    def _ask_for(self, arguments: Sequence[Value]) -> None:
        """Ask for the array that the arguments spread to, and for that of all those that are put side by side."""
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
                known[key] = _coerced(argument, key[1])
            array, found = known[key]
            arrays.append(array)
            errors = np.where(errors > 0, errors, found).astype(np.uint8)
        if errors.all():  # a body would compute what its arguments' errors cover, text by text at worst
            shape = np.broadcast_shapes(errors.shape, *(array.shape for array in arrays))
            return Value.of_errors(np.broadcast_to(errors, shape))
        arrays += [p.default for p in self.parameters[len(arguments) :] if not p.repeat]
        return _as_value(self.body(*arrays), self.returns, errors if errors.any() else None)

    def _of_sets(self, arguments: Sequence[Value]) -> Value:
        kind = self.parameters[0].kind
        x, counts, errors = _flattened(arguments, kind)
        return _as_value(self.body(x, counts), self.returns, errors if errors.any() else None)


def _coerced(value: Value, kind: Kind) -> tuple[NDArray[Any], Codes]:
    if kind is Kind.NUMBER:
        return value.to_numbers()
    return value.to_logicals() if kind is Kind.LOGICAL else value.to_texts()


def _as_value(result: Any, returns: Kind, errors: Codes | None) -> Value:
    if isinstance(result, Value):
        return result if errors is None else _overlaid(result, errors)
    array = np.atleast_1d(np.asarray(result))
    if errors is not None and array.ndim > errors.ndim:
        errors = errors[:, None, None]
    if errors is not None:
        array = np.broadcast_to(array, np.broadcast_shapes(array.shape, errors.shape))
    if array.dtype == object:
        return _overlaid(from_objects(array), errors)
    if returns is Kind.LOGICAL:
        return Value.of_logicals(array.astype(bool), errors)
    return Value.of_numbers(array.astype(np.float64, copy=False), errors)


def _overlaid(value: Value, errors: Codes | None) -> Value:
    """Argument errors go before whatever the body made of those trials."""
    if errors is None:
        return value
    if value.numbers.ndim > errors.ndim:
        errors = errors[:, None, None]
    kinds = np.where(errors > 0, errors + np.uint8(ERROR), value.kinds).astype(np.uint8)
    return Value(value.numbers, kinds, value.texts)


def _flattened(arguments: Sequence[Value], kind: Kind) -> tuple[NDArray[Any], Bools, Codes]:
    """All arguments side by side, `(n, k)`: the values, which of them count, and the first error of each trial.

    A value given directly is coerced, a cell of a range (n, r, c) counts only when it is of the kind itself.
    """
    columns, counted, errors = [], [], []
    for argument in arguments:
        in_range = argument.numbers.ndim == 3
        x, found = (argument.numbers, argument.errors) if in_range else _coerced(argument, kind)
        wanted = (argument.kinds == NUMBER) if kind is Kind.NUMBER else (argument.kinds <= LOGICAL)
        counts = (wanted if in_range else argument.kinds < ERROR) & (found == 0)
        columns.append(_two_axes(x, argument.shape))
        counted.append(_two_axes(counts, argument.shape))
        errors.append(_two_axes(found, argument.shape))
    n = max((column.shape[0] for column in columns), default=1)
    x, counts, found = (np.concatenate([_tall(a, n) for a in part], axis=1) for part in (columns, counted, errors))
    first = np.take_along_axis(found, (found > 0).argmax(axis=1, keepdims=True), axis=1)[:, 0]
    return (x if kind is Kind.NUMBER else x != 0), counts, first


def _two_axes(array: NDArray[Any], shape: tuple[int, ...]) -> NDArray[Any]:
    return np.broadcast_to(array, shape).reshape(shape[0], -1)


def _tall(array: NDArray[Any], n: int) -> NDArray[Any]:
    return np.broadcast_to(array, (n, array.shape[1]))


REGISTRY: Final[dict[str, Function]] = {}

_FAMILIES: Final = "xlmc.functions.families"
"""What imports all of them."""


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
    home = str(sys._getframe(1).f_globals["__name__"])  # a body may be NumPy's, which does not say

    def register(body: Callable[..., Any]) -> Callable[..., Any]:
        row = Function(name, parameters, body, returns, ufunc, guard, volatile, dated, macintosh, facts, home)
        for key in (name, *aliases):
            if key in REGISTRY:
                raise ValueError(f"{key} is registered twice, in {REGISTRY[key].home} and in {home}")
            REGISTRY[key] = row
        return body

    return register


def function_named(name: str) -> Function | None:
    """The row of an Excel function, its name in capitals and without `_xlfn.`; None when there is none."""
    return REGISTRY.get(name)


def row_of(name: str, module: str = _FAMILIES) -> Function:
    """The row of a name that has one, imported first if need be.

    Args:
        name: in capitals.
        module: where it is likely to be registered.
    """
    for home in (module, _FAMILIES):
        if name not in REGISTRY:
            import_module(home)
    return REGISTRY[name]
