"""The whole registry at once: trials do not mix, ufuncs keep their promise, bodies raise no flag without cause."""

from __future__ import annotations

import os
import pickle
import struct
import subprocess
import sys
from functools import partial, reduce
from math import isfinite
from random import Random

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from xlmc.engine.graph.called_functions import with_settings
from xlmc.errors import ErrorCode, FormulaError
from xlmc.excel.functions import Function, Kind
from xlmc.excel.functions.denormals import tiny_to_zero
from xlmc.excel.functions.families import REGISTRY, function_named
from xlmc.excel.functions.registry import Logical, Number, Numbers, Text, excel
from xlmc.excel.functions.values import ShapeVaries, Value, constant, from_objects

ROWS = {function.name: function for function in REGISTRY.values()}
FAST = {name: function for name, function in ROWS.items() if function.ufunc is not None}

SQUARED = {"^"}
"""NumPy squares by a multiplication where the exponent is one number for all trials, and by `pow` elsewhere."""

EDGES = [0.0, -0.0, 0.5, 1.0, 2.0, 2.5, -1.0, 170.0, 2.0**27, -(2.0**53), 1e15, 1e-320, -1e300, 1.7e308]
plain_numbers = (
    st.sampled_from(EDGES)
    | st.integers(-20, 20).map(float)
    | st.floats(-1e3, 1e3)
    | st.floats(allow_nan=False, allow_infinity=False)
)
TEXTS = ["", "abc", "ABC", "TRUE", "false", "12.5", " 7 %", "1e3", "#N/A"]
MANY = 1000
"""Cells in a result; SEQUENCE and MUNIT have them."""

seeds = st.integers(0, 2**64 - 1)

OBJECTS = (
    lambda random: random.choice(EDGES),
    lambda random: float(random.randint(-20, 20)),
    lambda random: random.uniform(-1e3, 1e3),
    lambda random: _any_number(random),
    lambda random: random.random() < 0.5,
    lambda random: random.choice(TEXTS),
    lambda random: None,
    lambda random: random.choice(list(ErrorCode)),
)
"""What a cell may hold. Hypothesis would draw the same item by item, in four times the time of the functions."""


def _any_number(random: Random) -> float:
    (number,) = struct.unpack("d", random.randbytes(8))
    return number if isfinite(number) else 0.0


def arguments_of(random: Random, function: Function, n: int) -> list[Value]:
    """Arguments of n trials or one, scalars or, all of one size, ranges."""
    fewest, most = function.arity()
    size = random.choice([(1, 1), (1, 3), (2, 2)])
    values = []
    for _ in range(random.randint(fewest, min(most, fewest + 2))):
        items = np.empty((random.choice([1, n]), *random.choice([(), (), size])), object)
        items.ravel()[:] = [random.choice(OBJECTS)(random) for _ in range(items.size)]
        values.append(from_objects(items))
    return values


def _bits(item: object) -> object:
    return struct.pack("d", item) if isinstance(item, float) else item


def _same_bits(value: Value, expected: Value) -> bool:
    """For results of many cells, of which objects would take long."""
    parts = [[np.broadcast_to(part, v.shape) for part in (v.numbers, v.kinds)] for v in (value, expected)]
    texts = [[] if v.texts is None else np.broadcast_to(v.texts, v.shape).tolist() for v in (value, expected)]
    return all(a.tobytes() == b.tobytes() for a, b in zip(*parts, strict=True)) and texts[0] == texts[1]


def _same(name: str, value: object, expected: object) -> bool:
    if name in SQUARED and isinstance(value, float) and isinstance(expected, float):
        return abs(value - expected) <= np.spacing(abs(expected))
    return type(value) is type(expected) and _bits(value) == _bits(expected)


def first_difference(function: Function, random: Random) -> str | None:
    """Where a function of trials together and of each alone differ, on arguments drawn at random."""
    n = random.randint(2, 5)
    arguments = arguments_of(random, function, n)
    try:
        together = function(arguments)
    except (ShapeVaries, FormulaError):  # to be called trial by trial, or refused for good
        return None
    for i in range(n):
        alone = function([argument.take(np.array([i])) for argument in arguments])
        result = together.take(np.array([i]))
        same = result.shape == alone.shape
        if same and result.numbers.size > MANY:
            same = _same_bits(result, alone)
        elif same:
            pairs = zip(*(np.ravel(value.objects()).tolist() for value in (result, alone)), strict=True)
            same = all(_same(function.name, *pair) for pair in pairs)
        if not same:
            return f"{function.name}, trial {i}: {result} together, {alone} alone: {arguments}"
    return None


@given(seed=seeds)
@settings(max_examples=15, deadline=None)
def test_trials_together_are_the_trials_alone(seed):
    """One test of all functions: what hypothesis does for a test takes longer than a function."""
    fixed = [function for function in ROWS.values() if not function.volatile]
    result = [first_difference(function, Random(f"{function.name} {seed}")) for function in fixed]
    assert [difference for difference in result if difference] == []


def _as_body_takes_them(function: Function, columns: list[np.ndarray]) -> list[np.ndarray]:
    return [x != 0 if function.parameter(i).kind is Kind.LOGICAL else x for i, x in enumerate(columns)]


def _flushing(ufunc, x, y):
    """As the fast path folds: numbers too small for Excel are 0 at each step."""
    return tiny_to_zero(np.float64(ufunc(x, y)))


@pytest.mark.parametrize("name", FAST)
@given(data=st.data())
@settings(max_examples=50, deadline=None)
def test_the_ufunc_is_the_function_where_no_flag_is_raised_and_the_guard_holds(name, data):
    function = FAST[name]
    n = data.draw(st.integers(1, 9))
    k = data.draw(st.sampled_from([1, 2, 12])) if function.takes_sets else function.arity()[1]
    columns = [tiny_to_zero(np.array(data.draw(st.lists(plain_numbers, min_size=n, max_size=n)))) for _ in range(k)]
    arrays = _as_body_takes_them(function, columns)
    if function.guard is not None and not function.guard(*arrays):
        return
    try:
        with np.errstate(divide="raise", over="raise", invalid="raise"):
            result = (
                reduce(partial(_flushing, function.ufunc), arrays) if function.takes_sets else function.ufunc(*arrays)
            )
    except FloatingPointError:
        return
    expected = function([Value.of_numbers(x) for x in columns])
    assert not expected.has_errors
    zero = 0.0  # the sign of a zero is no value of Excel's, and MIN and MAX may take either
    assert np.array_equal(tiny_to_zero(np.float64(result)) + zero, expected.numbers + zero)


def _takes_numbers(function: Function) -> bool:
    return not function.takes_values and Kind.TEXT not in {parameter.kind for parameter in function.parameters}


@pytest.mark.parametrize("name", [name for name in ROWS if _takes_numbers(ROWS[name])])
def test_ordinary_numbers_raise_no_flag(name):
    """A flag would send the block to the slow path."""
    function = ROWS[name]
    first = [np.array([0.25, 0.75]), np.array([0.5, 2.0])]
    columns = (first + [np.array([1.0, 0.0])] * len(function.parameters))[: len(function.parameters)]
    if name == "ACOSH":
        columns = [1 + column for column in columns]
    with np.errstate(divide="raise", over="raise", invalid="raise"):
        if function.takes_sets:
            (x,) = _as_body_takes_them(function, [np.array([[1.5, 2.0, 4.0], [7.0, -1.0, 0.0]])])
            function.body(x, np.array([[True, True, True], [True, False, True]]))
        else:
            function.body(*_as_body_takes_them(function, columns))


def _is_of_numbers(function: Function) -> bool:
    kinds = {parameter.kind for parameter in function.parameters}
    several = any(parameter.repeat for parameter in function.parameters)
    plain = kinds in ({Kind.NUMBER}, {Kind.NUMBER, Kind.LOGICAL}) and function.returns is Kind.NUMBER
    return plain and not several and not function.dated


def constants_differ(function: Function, random: Random) -> bool:
    """Whether a body's result depends on its constants coming as plain floats or as arrays."""
    k = len(function.parameters)
    numbers = np.array([random.choice([0.0, 0.25, 1.0, 2.0, -1.0, 3.0]) for _ in range(k)])
    varying = random.randrange(k)
    arrays = _as_body_takes_them(function, [np.full(2, number) for number in numbers])
    mixed = [array if i == varying else array[0].item() for i, array in enumerate(arrays)]
    with np.errstate(all="ignore"):
        result, expected = (np.asarray(function.body(*each)) for each in (mixed, arrays))
    return not np.array_equal(np.broadcast_to(result, expected.shape), expected, equal_nan=True)


@given(seed=seeds)
@settings(max_examples=25, deadline=None)
def test_constants_may_come_as_plain_floats(seed):
    """So they do on the fast path, where Python's own division by zero would be no error value."""
    functions = [function for function in ROWS.values() if _is_of_numbers(function)]
    assert [row.name for row in functions if constants_differ(row, Random(f"{row.name} {seed}"))] == []


def test_every_function_is_documented_and_named_in_capitals():
    names = [name for name in ROWS if name[0].isalpha() and name not in ("u-", "u+")]
    assert [name for name in names if name != name.upper()] == []
    assert [name for name in names if not ROWS[name].body.__doc__] == []


@pytest.mark.parametrize(
    ("alias", "name"),
    [("POWER", "^"), ("STDEV", "STDEV.S"), ("STDEVP", "STDEV.P"), ("VAR", "VAR.S"), ("VARP", "VAR.P")],
)
def test_aliases_are_the_same_row(alias, name):
    assert function_named(alias) is function_named(name)


def test_unknown_functions_are_none():
    assert function_named("SINN") is None


def test_a_name_cannot_be_registered_twice():
    with pytest.raises(ValueError, match="SIN is registered twice"):
        excel("SIN", Number)(np.sin)


@pytest.mark.parametrize(
    ("name", "fewest", "most"),
    [("PI", 0, 0), ("SIN", 1, 1), ("LOG", 1, 2), ("IF", 2, 3), ("SUM", 1, 255), ("CEILING.MATH", 1, 3)],
)
def test_arity(name, fewest, most):
    assert function_named(name).arity() == (fewest, most)


def test_the_last_parameters_repeat():
    function = Function("TEST", (Number, Logical, Number(repeat=True), Logical(repeat=True)), np.add, Kind.NUMBER)
    kinds = [function.parameter(position).kind for position in range(6)]
    assert kinds == [Kind.NUMBER, Kind.LOGICAL] * 3
    assert not function.takes_sets
    assert Function("TEST", (Numbers,), np.add, Kind.NUMBER).takes_sets


def test_a_row_goes_to_another_process_by_its_name():
    assert [name for name, row in ROWS.items() if pickle.loads(pickle.dumps(row)) is not row] == []


def test_where_nothing_is_imported_yet_it_is_found():
    """Those of the Analysis ToolPak are registered by another module than the one that makes their bodies.

    No row brings the module of the next.
    """
    names = ["+", "SIN", "YEARFRAC"]
    read = (
        "import pickle, sys\n"
        "for name in sys.argv[1:]:\n"
        "    packed = pickle.load(sys.stdin.buffer)\n"
        "    from xlmc.excel.functions.registry import REGISTRY\n"
        "    assert name not in REGISTRY\n"
        "    assert pickle.loads(packed) is REGISTRY[name]\n"
    )
    packed = b"".join(pickle.dumps(pickle.dumps(ROWS[name])) for name in names)
    where = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    done = subprocess.run([sys.executable, "-c", read, *names], input=packed, capture_output=True, env=where)
    assert done.returncode == 0, done.stderr.decode()


def test_one_made_for_a_workbook_goes_whole():
    made = with_settings(function_named("YEAR"), date1904=True, macintosh=False)
    result = pickle.loads(pickle.dumps(made))
    assert result is not made
    assert result([from_objects(np.array([0.5], object))]).numbers.tolist() == [1904.0]
    assert result.parameters == made.parameters
    assert all(parameter.required for parameter in result.parameters)


def test_a_body_is_not_called_where_every_trial_has_an_error_in_its_arguments():
    def body(*_):
        raise AssertionError("called")

    row = Function("TEST", (Text, Text), body, Kind.TEXT)
    codes = np.array([ErrorCode.DIV0, ErrorCode.NA], np.uint8)
    result = row([Value.of_errors(codes), constant("x")])
    assert result.objects().tolist() == [ErrorCode.DIV0, ErrorCode.NA]
    over_cells = row([Value.of_errors(codes[:1]), constant("x").as_range().take(np.zeros(1, np.intp))])
    assert over_cells.objects().tolist() == [[[ErrorCode.DIV0]]]
