"""Functions called as a formula calls them, with Python objects for values and nested lists for ranges."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest

from xlmc.excel.functions.families import function_named
from xlmc.excel.functions.values import ERROR, Value, constant, from_objects


def _value(item: object) -> Value:
    if not isinstance(item, list):
        return constant(item)
    box = np.empty((1, len(item), len(item[0])), object)
    box[0] = item
    return from_objects(box)


def _evaluate(name: str, *arguments: object) -> object:
    function = function_named(name)
    assert function is not None, f"{name} is not registered"
    fewest, most = function.arity()
    assert fewest <= len(arguments) <= most
    result = function([_value(item) for item in arguments]).objects()
    return result[0] if result.ndim == 1 else result[0].tolist()


@pytest.fixture(scope="session")
def value() -> Callable[[object], Value]:
    """An object or a list of rows as the value of one trial."""
    return _value


@pytest.fixture(scope="session")
def evaluate() -> Callable[..., object]:
    """`evaluate("SUM", 1, [[2, None]])`: an object, or a list of rows."""
    return _evaluate


@pytest.fixture(scope="session")
def check() -> Callable[..., None]:
    """Whether a function gives what is expected: the same kind and the same value, numbers to `rel`."""

    def compare(name: str, arguments: tuple[object, ...], expected: object, rel: float = 0.0) -> None:
        result = _evaluate(name, *arguments)
        wanted = float(expected) if type(expected) is int else expected
        assert type(result) is type(wanted), f"{result!r} instead of {wanted!r}"
        same = math.isclose(result, wanted, rel_tol=rel) if isinstance(wanted, float) else result == wanted
        assert same, f"{result!r} instead of {wanted!r}"

    return compare


@pytest.fixture(scope="session")
def shows() -> Callable[..., None]:
    """Whether a result rounds to the digits that Excel's help prints: `shows("PHI", (0.75,), "0.301137432")`."""

    def compare(name: str, arguments: tuple[object, ...], printed: str) -> None:
        result = _evaluate(name, *arguments)
        assert isinstance(result, float)
        unit = 10.0 ** -len(printed.partition(".")[2])
        assert abs(result - float(printed)) <= 0.5 * unit * (1 + 1e-6), f"{result!r} instead of {printed}"

    return compare


@pytest.fixture(scope="session")
def over_trials() -> Callable[..., np.ndarray]:
    """`over_trials("PHI", z)`: a function of numbers or arrays (n,), NaN for errors."""

    def evaluate(name: str, *arguments: object) -> np.ndarray:
        function = function_named(name)
        assert function is not None
        result = function([Value.of_numbers(np.atleast_1d(np.asarray(a, np.float64))) for a in arguments])
        return np.where(result.kinds >= ERROR, np.nan, result.numbers)

    return evaluate
