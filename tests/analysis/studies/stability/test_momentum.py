"""The paper's equations as trees: which formulas are recognised, and that the other forms are the same numbers."""

from __future__ import annotations

import math
import re
from types import SimpleNamespace

import numpy as np
import pytest

from xlmc.analysis.studies.stability.formula_trees import Trees
from xlmc.analysis.studies.stability.momentum import (
    Momentum,
    _component,
    _is_change,
    _momentum,
    angle_of,
    components,
    sine,
    spin,
    times,
)
from xlmc.excel.address import Cell, parse_address
from xlmc.excel.formula import ir

AT = {"m1": "A1", "m2": "A2", "v1": "A3", "v2": "A4", "a1": "A5", "b1": "A6", "a2": "A7", "b2": "A8", "V1": "A9"}
AT |= {"V2": "A10", "inertia": "A11", "a": "A12", "b": "A13", "w": "A14"}
GIVEN = {"m1": 5.0, "m2": 3.0, "v1": 20.0, "v2": 15.0, "a1": 186.0, "b1": 190.0, "a2": 282.0, "b2": 197.0}
GIVEN |= {"inertia": 7.0, "a": 1.25, "b": -0.75, "w": 0.5}


def numbers(in_degrees=True):
    """The given numbers, and the speeds before the impact by which momentum is kept."""
    given = dict(GIVEN)
    angles = {name: math.radians(given[name]) for name in ("a1", "b1", "a2", "b2")}
    if not in_degrees:
        given |= angles
    before = np.array([[given[f"m{n}"] * turn(angles[f"a{n}"]) for n in (1, 2)] for turn in (math.cos, math.sin)])
    after = [
        sum(given[f"m{n}"] * given[f"v{n}"] * turn(angles[f"b{n}"]) for n in (1, 2)) for turn in (math.cos, math.sin)
    ]
    given["V1"], given["V2"] = np.linalg.solve(before, after)
    return given


def value(tree, given):
    match tree:
        case Cell():
            return given[next(name for name, address in AT.items() if parse_address(address, "S") == tree)]
        case ir.Number(number):
            return number
        case ir.Unary("-", operand):
            return -value(operand, given)
        case ir.Binary(operator, left, right):
            x, y = value(left, given), value(right, given)
            return {"+": x + y, "-": x - y, "*": x * y, "/": x / y}[operator]
        case ir.Call(name, (argument,)):
            function = {"SIN": math.sin, "COS": math.cos, "RADIANS": math.radians}[name]
            return function(value(argument, given))
    raise AssertionError(tree)


@pytest.fixture(scope="module")
def tree(model_of):
    """`tree("m1*SIN(a1-a2)")`: the formula with the cells of `AT`."""

    def make(text):
        for name in sorted(AT, key=len, reverse=True):
            text = text.replace(f"<{name}>", AT[name])
        cells = {address: GIVEN.get(name, 1.0) for name, address in AT.items()} | {"Z1": f"={text}"}
        model = model_of(cells, {"x": {"cell": "A1", "low": 4.0, "high": 6.0}}, {"y": "Z1"})
        return Trees(model).formula(parse_address("Z1", "S"))

    return make


def cell(name):
    return parse_address(AT[name], "S")


def test_products_and_angles():
    a, b, c = cell("a1"), cell("b1"), cell("a2")
    assert times(a) == a
    assert times(a, b, c) == ir.Binary("*", ir.Binary("*", a, b), c)
    assert angle_of(ir.Call("COS", (a,)), "COS") == a
    assert angle_of(ir.Call("COS", (a,)), "SIN") is None
    assert angle_of(a, "COS") is None


def test_a_sine_of_a_difference_is_subtracted_in_degrees():
    a, b = cell("a1"), cell("a2")

    def radians(x):
        return ir.Call("RADIANS", (x,))

    assert sine(radians(a), radians(b)) == ir.Call("SIN", (radians(ir.Binary("-", a, b)),))
    for left, right in ((a, b), (radians(a), b), (a, radians(b))):
        assert sine(left, right) == ir.Call("SIN", (ir.Binary("-", left, right),))


FIFTEEN = [
    "(<m1>*<v1>*SIN(R(<b1>-<a2>))-<m2>*<v2>*SIN(R(<a2>-<b2>)))/(<m1>*SIN(R(<a1>-<a2>)))",
    "(<m2>*<v2>*SIN(R(<b2>-<a2>))+SIN(R(<b1>-<a2>))*<v1>*<m1>)/SIN(R(<a1>-<a2>))/<m1>",
]


@pytest.mark.parametrize("form", ["degrees", "each in degrees", "radians"])
@pytest.mark.parametrize("text", FIFTEEN)
def test_equation_15_is_recognised(tree, text, form):
    text = text.replace("SIN(R(", "SIN(RADIANS(") if form == "degrees" else text
    if form == "each in degrees":
        text = re.sub(r"R\((<\w+>)-(<\w+>)\)", r"RADIANS(\1)-RADIANS(\2)", text)
    made = tree(text.replace("R(", "(") if form == "radians" else text)
    known = _momentum(made)
    assert known is not None
    assert (known.masses[0], known.speeds[0]) == (cell("m1"), cell("v1"))
    assert {known.masses[1], known.speeds[1]} == {cell("m2"), cell("v2")}
    assert (known.before, known.after) == ((cell("a1"), cell("a2")), (cell("b1"), cell("b2")))
    assert known.in_degrees is (form != "radians")
    given = numbers(known.in_degrees)
    assert value(made, given) == pytest.approx(given["V1"])


@pytest.mark.parametrize(
    "text",
    [
        "<m1>*<v1>",
        "(<m1>*<v1>*SIN(<b1>-<a2>)-<m2>*<v2>*SIN(<a2>-<b2>))/<m1>",  # no sine below
        "(<m1>*<v1>*SIN(<b1>-<a2>)-<m2>*<v2>*SIN(<a2>-<b2>))/SIN(<a1>-<a2>)",  # no mass below
        "(<m1>*<v1>*SIN(<b1>-<a2>)-<m2>*<v2>*SIN(<a2>-<b2>))/(<m1>*<w>*SIN(<a1>-<a2>))",
        "(<m1>*<v1>*SIN(<b1>-<a2>)-<m2>*<v2>*SIN(<a2>-<b2>))/(<m1>*SIN(<a1>))",
        "(<m1>*<v1>*SIN(<b1>-<a2>)-<m2>*<v2>*SIN(<a2>-<b2>)+<w>)/(<m1>*SIN(<a1>-<a2>))",
        "(<m1>*<v1>*SIN(<b1>-<a2>)-<m1>*<v2>*SIN(<a2>-<b2>))/(<m1>*SIN(<a1>-<a2>))",  # one mass alone
        "(<m1>*<v1>*<w>*SIN(<b1>-<a2>)-<m2>*<v2>*SIN(<a2>-<b2>))/(<m1>*SIN(<a1>-<a2>))",
        "(<m1>*<v1>*SIN(<b1>-<a2>)-<m2>*<v2>*<w>*SIN(<a2>-<b2>))/(<m1>*SIN(<a1>-<a2>))",
        "(<m1>*<v1>*SIN(<b1>-<w>)-<m2>*<v2>*SIN(<a2>-<b2>))/(<m1>*SIN(<a1>-<a2>))",  # another course
        "(<m1>*<v1>*SIN(<b1>-<a2>)-<m2>*<v2>*SIN(<a2>-<a1>))/(<m1>*SIN(<a1>-<a2>))",
        "(<m1>*<v1>*COS(<b1>-<a2>)-<m2>*<v2>*SIN(<a2>-<b2>))/(<m1>*SIN(<a1>-<a2>))",
        "(<m1>*<v1>*SIN(<b1>+<a2>)-<m2>*<v2>*SIN(<a2>-<b2>))/(<m1>*SIN(<a1>-<a2>))",
        "(<m1>*<v1>*SIN(<b1>-<a2>)/<w>-<m2>*<v2>*SIN(<a2>-<b2>))/(<m1>*SIN(<a1>-<a2>))",
    ],
)
def test_what_is_not_equation_15(tree, text):
    assert _momentum(tree(text)) is None


@pytest.mark.parametrize("in_degrees", [True, False])
@pytest.mark.parametrize("vehicle", [0, 1])
@pytest.mark.parametrize("function", ["COS", "SIN"])
def test_equation_20_without_a_difference_of_speeds(in_degrees, vehicle, function):
    pairs = [tuple(cell(f"{name}{n}") for n in (1, 2)) for name in ("m", "v", "a", "b")]
    built = _component(Momentum(*pairs, in_degrees), vehicle, function)
    given, n = numbers(in_degrees), vehicle + 1
    turn = {"COS": math.cos, "SIN": math.sin}[function]
    after, before = (given[f"{angle}{n}"] for angle in ("b", "a"))
    if in_degrees:
        after, before = math.radians(after), math.radians(before)
    change = given[f"v{n}"] * turn(after) - given[f"V{n}"] * turn(before)
    assert value(built, given) == pytest.approx(change, rel=1e-12)


@pytest.mark.parametrize(
    ("text", "cosine", "sine_"),
    [
        ("<v1>*COS(<b1>)-<V1>*COS(<a1>)", True, False),
        ("<v1>*SIN(<b1>)-<V1>*SIN(<a1>)", False, True),
        ("-(<V1>*COS(<a1>))+<v1>*COS(<b1>)", True, False),
        ("<v1>*COS(<b1>)+<V1>*COS(<a1>)", False, False),
        ("<v1>*COS(<b1>)-<V1>*SIN(<a1>)", False, False),
        ("<v1>*COS(<b1>)-<V1>*COS(<a1>)-<w>", False, False),
        ("<v1>*COS(<b1>)", False, False),
    ],
)
def test_equation_20_is_recognised(tree, text, cosine, sine_):
    made = tree(text)
    assert (_is_change(made, "COS"), _is_change(made, "SIN")) == (cosine, sine_)


def test_every_form_of_a_change_of_speed_is_offered(tree):
    fifteen, change = (
        tree(FIFTEEN[0].replace("R(", "RADIANS(")),
        tree("<v1>*COS(RADIANS(<b1>))-<V1>*COS(RADIANS(<a1>))"),
    )
    formulas = {"speed": fifteen, "other": tree("<m1>+<m2>")}
    case = SimpleNamespace(cells=[*formulas], trees=SimpleNamespace(formula=formulas.__getitem__))
    given = numbers()
    values = [value(each, given) for each in components(case, change)]
    assert len(values) == 4  # of either vehicle, with either factor as the mass
    assert any(each == pytest.approx(value(change, given), rel=1e-12) for each in values)
    assert [*components(case, fifteen)] == []


SEVENTEEN = [
    "<m1>/<inertia>*<v1>*(COS(<b1>)*<b>-SIN(<b1>)*<a>)-<m1>/<inertia>*<V1>*(COS(<a1>)*<b>-SIN(<a1>)*<a>)",
    "-(<m1>*<V1>*(COS(<a1>)*<b>-SIN(<a1>)*<a>)/<inertia>)+<v1>*<m1>*(<b>*COS(<b1>)-<a>*SIN(<b1>))/<inertia>",
    "<m1>*<v1>*(COS(<b1>)*<b>-SIN(<b1>)*<a>)-<m1>*<V1>*(COS(<a1>)*<b>-SIN(<a1>)*<a>)",
]


@pytest.mark.parametrize("more", ["", "+<w>", "-<w>"])
@pytest.mark.parametrize("text", SEVENTEEN)
def test_equation_17_with_one_subtraction_of_speeds(tree, text, more):
    made = tree(text + more)
    built = spin(made)
    given = numbers(in_degrees=False)
    assert value(built, given) == pytest.approx(value(made, given), rel=1e-12)
    assert built != made
    written = str(built)
    assert written.count("'COS'") == written.count("'SIN'") == 2


@pytest.mark.parametrize(
    "text",
    [
        "<m1>*<v1>*(COS(<b1>)*<b>-SIN(<b1>)*<a>)",
        "<m1>*<v1>*(COS(<b1>)*<b>-SIN(<b1>)*<a>)+<m1>*<V1>*(COS(<a1>)*<b>-SIN(<a1>)*<a>)",
        "<m1>*<v1>*(COS(<b1>)*<b>-SIN(<b1>)*<a>)-<m1>*<V1>*(COS(<a1>)*<a>-SIN(<a1>)*<b>)",  # other arms
        "<m1>*<v1>*(COS(<b1>)*<b>+SIN(<b1>)*<a>)-<m1>*<V1>*(COS(<a1>)*<b>+SIN(<a1>)*<a>)",
        "<m1>*<v1>*(COS(<b1>)*<b>-SIN(<a1>)*<a>)-<m1>*<V1>*(COS(<a1>)*<b>-SIN(<a1>)*<a>)",  # two angles
        "<m1>*<v1>*(COS(<b1>)*<b>-SIN(<b1>)*<a>)-<m2>*<V1>*(COS(<a1>)*<b>-SIN(<a1>)*<a>)",  # nothing in common
        "<m1>*<v1>*(COS(<b1>)*<b>-SIN(<b1>)*<a>)/<inertia>-<m1>*<V1>*(COS(<a1>)*<b>-SIN(<a1>)*<a>)",
        "<m1>*<v1>*(COS(<b1>)*<b>-SIN(<b1>)*<a>)-<m1>*<V1>*(COS(<a1>)*<b>-SIN(<a1>)*<a>)/<inertia>",
        "<m1>*<v1>*<w>*(COS(<b1>)*<b>-SIN(<b1>)*<a>)-<m1>*<V1>*(COS(<a1>)*<b>-SIN(<a1>)*<a>)",
        "<m1>*<v1>*(COS(<b1>)*<b>/<w>-SIN(<b1>)*<a>)-<m1>*<V1>*(COS(<a1>)*<b>-SIN(<a1>)*<a>)",
        "<m1>*<v1>*(COS(<b1>)-SIN(<b1>)*<a>)-<m1>*<V1>*(COS(<a1>)-SIN(<a1>)*<a>)",
    ],
)
def test_what_is_not_equation_17(tree, text):
    assert spin(tree(text)) is None
