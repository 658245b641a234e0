"""Functions of a person's own, written in Python, which stand in for those of VBA and of add-ins in formulas.

The file is Python that the person names: it is run. Nothing is ever loaded because it lies beside a workbook. A formula
calls the function of its name, whatever the case; a dot in a name is an underscore in Python.
"""

from __future__ import annotations

import hashlib
import inspect
import linecache
import sys
import traceback
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from importlib.abc import SourceLoader
from numbers import Real
from pathlib import Path
from types import ModuleType
from typing import Any, Final, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from xlmc.errors import ErrorCode, FormulaError, WorkbookError
from xlmc.excel.functions.registry import Cells, Function, Kind, Parameter
from xlmc.excel.functions.values import BLANK, TEXT, Codes, Value, from_objects, unbox_errors

__all__ = ["OwnFunctions", "load_functions", "numbers_given", "scalar", "the_same_functions"]

F = TypeVar("F", bound=Callable[..., Any])

_SCALAR: Final = "_xlmc_scalar"
_TRIED: Final = 2
"""Trials that a function is called with a second time, to see that each depends on its own values alone."""


def scalar(function: F) -> F:
    """Mark a function of `--functions` that takes one trial at a time: plain numbers and texts, and gives one.

    >>> @scalar
    ... def Steps(load, step):
    ...     count = 0
    ...     while load > step:
    ...         load, count = load - step, count + 1
    ...     return count
    """
    setattr(function, _SCALAR, True)
    return function


@dataclass(frozen=True, slots=True)
class OwnFunctions:
    """The functions of a file.

    Attributes:
        path: of the file.
        sha256: of its contents.
        source: its contents.
        rows: what a formula calls, by name in capitals.
    """

    path: Path
    sha256: str
    source: bytes = field(repr=False)
    rows: Mapping[str, Function] = field(repr=False)

    @property
    def file(self) -> str:
        """The name of the file."""
        return self.path.name

    @property
    def names(self) -> tuple[str, ...]:
        """The names of the functions, as written."""
        return tuple(_body_of(row).name for row in self.rows.values())

    def named(self, name: str, arguments: int) -> Function | None:
        """Return the row of a function that a formula calls; None if there is none.

        Args:
            name: in capitals.
            arguments: how many it is given.

        Raises:
            FormulaError: the function takes another number of arguments.
        """
        row = self.rows.get(name.replace(".", "_"))
        if row is None:
            return None
        body, (fewest, most) = _body_of(row), row.arity()
        if not fewest <= arguments <= most:
            takes = f"{fewest}" if fewest == most else f"{fewest} or more" if most == 255 else f"{fewest} to {most}"
            message = (
                f"the function {body.name} is given {arguments} argument{'s' * (arguments != 1)}, and takes {takes}"
            )
            raise FormulaError(message, hint=f"correct the formula, or the function in {body.file}")
        return row


def load_functions(path: str | Path) -> OwnFunctions:
    """Run a file of Python, and return the functions that are defined in it; those that begin with `_` are its own.

    With `__all__` these are what it lists.

    Raises:
        WorkbookError: the file cannot be read or run, or defines no function that a formula can call.
    """
    path = Path(path)
    try:
        source = path.read_bytes()
    except OSError as error:
        hint = "Name a file of Python: --functions my_functions.py"
        raise WorkbookError(f"the file cannot be read ({error.strerror or error})", where=path, hint=hint) from error
    module = _module(source, str(path))
    rows: dict[str, Function] = {}
    for name, function in _public(module, path):
        body = _Body(source, str(path), name, function)
        key = name.upper()
        _refuse_name(name, key, rows, path)
        rows[key] = _row(body)
    if not rows:
        hint = "Define one: def BeamMoment(load, span): return load * span / 4"
        raise WorkbookError("the file defines no function", where=path, hint=hint)
    return OwnFunctions(path, hashlib.sha256(source).hexdigest(), source, rows)


def the_same_functions(given: OwnFunctions | None, file: str, sha256: str, where: Path) -> OwnFunctions:
    """Return the functions that a recorded run was made with.

    Args:
        given: what the person named; None for nothing.
        file: the name of the file that is recorded.
        sha256: of that.
        where: the file with the record.

    Raises:
        WorkbookError: they are not those.
    """
    if given is None:
        hint = f"name it: --functions FOLDER/{file} (in Python: functions=…); it is run, so look at it first"
        raise WorkbookError(
            f"formulas of this run call functions of {file!r}, which it does not hold", where=where, hint=hint
        )
    if given.sha256 != sha256:
        message = f"this is not the file {file!r} that the run was made with: its SHA-256 is not {sha256}"
        raise WorkbookError(message, where=given.path, hint="Find that file, or run the workbook again")
    return given


def _refuse_name(name: str, key: str, rows: Mapping[str, Function], path: Path) -> None:
    from xlmc.excel.functions.families import function_named

    if function_named(key) is not None or function_named(key.replace("_", ".")) is not None:
        hint = "Give it another name; helpers of the file begin with _, such as _average"
        message = f"the function {name} has the name of one of Excel, which xlmc computes itself"
        raise WorkbookError(message, where=path, hint=hint)
    if key in rows:
        message = f"the functions {_body_of(rows[key]).name} and {name} have one name in Excel, which ignores case"
        raise WorkbookError(message, where=path, hint="Rename one of them")


class _Contents(SourceLoader):
    """Python's own loader of modules, for contents that were read already."""

    def __init__(self, source: bytes, path: str) -> None:
        self._source, self._path = source, path

    def get_filename(self, fullname: str) -> str:
        """Return the path of the file."""
        return self._path

    def get_data(self, path: str | bytes) -> bytes:
        """Return the contents of the file."""
        return self._source

    def path_stats(self, path: str) -> Mapping[str, Any]:
        """Refuse to say how old the file is, so that no compiled copy of it is looked for or written."""
        raise OSError


@cache
def _module(source: bytes, path: str) -> ModuleType:
    """Run the contents of a file, once in each process.

    Raises:
        WorkbookError: that fails.
    """
    name = f"xlmc_functions_{hashlib.sha256(source).hexdigest()[:16]}"
    loader = _Contents(source, path)
    module = ModuleType(name)
    module.__file__ = path
    sys.modules[name] = module  # where dataclasses look up their module
    try:
        loader.exec_module(module)
    except SyntaxError as error:
        if error.lineno is None:  # no text at all, such as a workbook
            hint = "Name a file of Python: --functions my_functions.py"
            raise WorkbookError(f"the file is not Python: {error.msg}", where=path, hint=hint) from error
        message = f"the file is not Python: {error.msg} (line {error.lineno})"
        raise WorkbookError(message, where=path, hint="Correct that line") from error
    except Exception as error:  # whatever a person's code raises becomes a message
        message = f"the file fails when it is run: {_fault_in_words(error, path)}"
        raise WorkbookError(message, where=path, hint="Correct it; python can run it alone") from error
    return module


def _fault_in_words(error: BaseException, path: str) -> str:
    """Return an error in words, with the line of the file in which it arose."""
    lines = [frame.lineno for frame in traceback.extract_tb(error.__traceback__) if frame.filename == path]
    linecache.checkcache(path)
    return f"{type(error).__name__}: {error}" + (f" (line {lines[-1]})" if lines else "")


def _public(module: ModuleType, path: Path) -> list[tuple[str, Callable[..., Any]]]:
    """Return the functions of a module that formulas may call, by name.

    Raises:
        WorkbookError: `__all__` names what is no function.
    """
    listed = getattr(module, "__all__", None)
    if listed is None:
        result = ((name, each) for name, each in vars(module).items() if not name.startswith("_"))
        return [
            (name, each) for name, each in result if getattr(each, "__module__", "") == module.__name__ and _is(each)
        ]
    wrong = next((name for name in listed if not _is(getattr(module, name, None))), None)
    if wrong is not None:
        raise WorkbookError(f"__all__ lists {wrong!r}, which is no function", where=path, hint="Correct it")
    return [(name, getattr(module, name)) for name in listed]


def _is(value: object) -> bool:
    return callable(value) and not isinstance(value, type)


def _row(body: _Body) -> Function:
    home = f"{body.file}, of the person"
    return Function(body.name.upper(), _parameters(body.function), body, Kind.NUMBER, home=home)


def _parameters(function: Callable[..., Any]) -> tuple[Parameter, ...]:
    """Return an argument that may be a range for each of the function's own; those with a default may be left out."""
    try:
        given = list(inspect.signature(function).parameters.values())
    except (TypeError, ValueError):  # a function of another language that does not tell
        return (Cells(repeat=True, default=None),)
    parameters = []
    for each in given:
        if each.kind is each.VAR_POSITIONAL:
            parameters.append(Cells(repeat=True, default=None))
        elif each.kind in (each.POSITIONAL_ONLY, each.POSITIONAL_OR_KEYWORD):
            parameters.append(Cells if each.default is each.empty else Cells(default=None))
    return tuple(parameters)


def _body_of(row: Function) -> _Body:
    assert isinstance(row.body, _Body)
    return row.body


@dataclass(slots=True)
class _Body:
    """What the engines call in place of a function: values in, one value out.

    Attributes:
        source, path: of the file; another process makes the function of these.
        name: of the function, as written.
        function: itself.
        tried: it has been seen to compute each trial from its own values.
    """

    source: bytes = field(repr=False)
    path: str
    name: str
    function: Callable[..., Any]
    tried: bool = False

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored, (self.source, self.path, self.name)

    @property
    def file(self) -> str:
        """The name of the file."""
        return Path(self.path).name

    def __call__(self, *values: Value) -> Value:
        """Return what the function gives; an error of an argument where there is one, #NUM! for what is no number.

        Raises:
            FormulaError: the function raised an exception, or gives something else than it must.
        """
        values = tuple(_of_one_cell(value) for value in values)
        n = max((value.shape[0] for value in values), default=1)
        errors = np.zeros(n, np.uint8)
        for value in values:
            errors = np.where(errors > 0, errors, _first_errors(value, n)).astype(np.uint8)
        good = np.flatnonzero(errors == 0)
        if not good.size:
            return Value.of_errors(errors)
        result = self._of_good(values, n, good)
        if good.size == n:
            return result
        spread = np.full(n, None, object)
        spread[good] = result.objects()
        spread[errors > 0] = [ErrorCode(int(code)) for code in errors[errors > 0]]
        return from_objects(spread)

    def _of_good(self, values: Sequence[Value], n: int, good: NDArray[np.intp]) -> Value:
        """Return what the function gives for the trials without an error."""
        if getattr(self.function, _SCALAR, False):
            columns = [_objects(value, n)[good] for value in values]
            rows = zip(*columns, strict=True) if columns else [()] * good.size
            given = np.empty(good.size, object)
            given[:] = [self._plain(self._called(row)) for row in rows]
            return from_objects(given)
        arguments = [_array(value, n)[good] for value in values]
        result = self._result(self._called(arguments), good.size)
        if not self.tried and good.size > _TRIED:
            again = self._result(self._called([each[:_TRIED].copy() for each in arguments]), _TRIED)
            self._refuse_mixing(result.objects()[:_TRIED], again.objects())
            self.tried = True
        return result

    def _called(self, arguments: Sequence[Any]) -> Any:
        try:
            with np.errstate(all="ignore"):
                return self.function(*arguments)
        except Exception as error:  # whatever a person's code raises becomes a message
            hint = f"correct the function; it is called with {self._shapes(arguments)}"
            raise self._error(f"failed: {_fault_in_words(error, self.path)}", hint) from error

    def _shapes(self, arguments: Sequence[Any]) -> str:
        if getattr(self.function, _SCALAR, False):
            return f"one trial at a time: {', '.join(map(_short, arguments))}"
        shapes = {f"({', '.join(map(str, each.shape))}{',' * (each.ndim == 1)})" for each in arguments}
        return f"arrays of the shape {' and '.join(sorted(shapes))}, a value for each trial"

    def _refuse_mixing(self, values: NDArray[Any], again: NDArray[Any]) -> None:
        """Refuse a function that gives other values for the same trials when it is called with fewer."""
        for first, second in zip(values.tolist(), again.tolist(), strict=True):
            same = first == second
            if isinstance(first, float) and isinstance(second, float):
                same = bool(np.isclose(first, second, rtol=1e-9, atol=0.0, equal_nan=True))
            if not same:
                message = f"gives {first!r}, and {second!r} for the same values when it is called with fewer trials"
                hint = "it must compute each trial from that trial's values alone, and draw nothing at random"
                raise self._error(message, hint)

    def _result(self, given: ArrayLike | None, n: int) -> Value:
        """Return the value of what a vectorised function gives for n trials."""
        values = _texts(given)
        if values is None:
            if given is None:
                raise self._error("gives nothing", "end it with return and the result")
            try:
                values = numbers_given(given)
            except ValueError as error:
                raise self._error(str(error), "give an array of numbers, of TRUE and FALSE, or of texts") from None
        if values.shape not in ((), (1,), (n,)):
            message = f"gives the shape {values.shape} for {n} trials"
            hint = "give one value for each trial: use numpy.where in place of if, or write @scalar above the function"
            raise self._error(message, hint)
        spread = np.array(np.broadcast_to(values, (n,)))
        if spread.dtype == object:
            return from_objects(spread)
        if spread.dtype == bool:
            return Value.of_logicals(spread)
        numbers = spread.astype(np.float64)
        return Value.of_numbers(numbers, unbox_errors(np.where(np.isfinite(numbers), numbers, np.nan)))

    def _plain(self, given: object) -> object:
        """Return what a function of one trial gives, as a cell has it."""
        if isinstance(given, np.generic | np.ndarray) and np.size(given) == 1:
            given = given.item()
        if isinstance(given, bool | str):
            return given
        if isinstance(given, Real):
            number = float(given)
            return number if np.isfinite(number) else ErrorCode.NUM
        what = "nothing" if given is None else f"a {type(given).__name__}"
        raise self._error(f"gives {what}", "give one number, TRUE or FALSE, or a text for each trial")

    def _error(self, message: str, hint: str) -> FormulaError:
        """Make an error, to which the engine adds the cell."""
        return FormulaError(f"the function {self.name} of {self.file} {message}", hint=hint)


def _restored(source: bytes, path: str, name: str) -> _Body:
    return _Body(source, path, name, getattr(_module(source, path), name))


def _of_one_cell(value: Value) -> Value:
    """Return the value of a range of one cell as that of the cell."""
    if value.shape[1:] != (1, 1):
        return value
    kinds = value.kinds.reshape(-1) if value.kinds.ndim == 3 else value.kinds
    return Value(value.numbers[:, 0, 0], kinds, None if value.texts is None else value.texts[:, 0, 0])


def _first_errors(value: Value, n: int) -> Codes:
    """Return the first error of each trial, 0 for none; `(n,)`."""
    errors = value.errors
    flat = errors.reshape(errors.shape[0], -1)
    first = flat[np.arange(flat.shape[0]), np.argmax(flat > 0, axis=1)]
    return np.broadcast_to(first, (n,))


def _array(value: Value, n: int) -> NDArray[Any]:
    """Return what a vectorised function is given: numbers, `(n,)` or `(n, r, c)`; objects where there is a text."""
    shape = (n, *value.shape[1:])
    if (value.kinds == TEXT).any():
        return _objects(value, n)
    return np.array(np.broadcast_to(value.numbers, shape), np.float64)


def _objects(value: Value, n: int) -> NDArray[Any]:
    """Return a plain value for each trial, a blank as 0; of a range an array `(r, c)` for each trial."""
    if value.numbers.ndim == 1:
        values = (
            np.where(value.kinds == BLANK, 0.0, value.objects()) if (value.kinds == BLANK).any() else value.objects()
        )
        return np.array(np.broadcast_to(values, (n,)), object)
    rows = np.empty(n, object)
    numbers = None if (value.kinds == TEXT).any() else value.numbers
    spread = np.broadcast_to(value.objects() if numbers is None else numbers, (n, *value.shape[1:]))
    for trial in range(n):
        rows[trial] = np.array(spread[trial])
    return rows


def _texts(given: object) -> NDArray[Any] | None:
    """Return an array of objects where a function gives texts, perhaps with numbers among them; otherwise None."""
    if isinstance(given, np.ma.MaskedArray):
        return None
    try:
        values = np.asarray(given)
    except ValueError:
        return None
    if values.dtype.kind == "U":
        return values.astype(object)
    if values.dtype != object or not any(isinstance(each, str) for each in values.ravel()):
        return None
    if not all(isinstance(each, str | bool | Real) for each in values.ravel()):
        return None
    return np.array([each if isinstance(each, str | bool) else float(each) for each in values.ravel()], object).reshape(
        values.shape
    )


def numbers_given(given: ArrayLike) -> NDArray[Any]:
    """Return what a function of Python gives as an array of numbers or logicals.

    Raises:
        ValueError: it is something else, which NumPy would make numbers of: complex numbers lose a part, masked ones
            show what is behind the mask, texts and dates count something.
    """
    if isinstance(given, np.ma.MaskedArray):
        raise ValueError("gives a masked array, and not result.filled(numpy.nan)")
    try:
        values = np.asarray(given)
        if values.dtype.kind == "O" and all(isinstance(each, Real) for each in values.ravel()):
            values = values.astype(np.float64)
    except (TypeError, ValueError, OverflowError) as error:
        raise ValueError(f"gives no array of numbers ({error})") from error
    if values.dtype.kind not in "biuf":
        kinds = {"U": "texts", "S": "bytes", "M": "dates", "m": "spans of time", "c": "complex numbers"}
        raise ValueError(f"gives {kinds.get(values.dtype.kind, 'objects')} instead of real numbers")
    return values


def _short(value: object) -> str:
    text = repr(value)
    return text if len(text) < 40 else f"{text[:37]}…"
