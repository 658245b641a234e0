from __future__ import annotations

import numpy as np
import pytest

from xlmc.engine.numpy.steps import plain_constant, reads
from xlmc.errors import ErrorCode
from xlmc.excel.functions import Kind
from xlmc.excel.functions.families import REGISTRY
from xlmc.excel.functions.values import constant

ELEMENTS = sorted(
    name
    for name, function in REGISTRY.items()
    if function.parameters and all(p.kind in (Kind.NUMBER, Kind.LOGICAL) and not p.ranged for p in function.parameters)
)


@pytest.mark.parametrize("name", ELEMENTS)
def test_no_function_of_numbers_gives_back_its_argument(name):
    """What it gives outlives the buffers that its arguments lie in."""
    function = REGISTRY[name]
    dated = {"date1904": False} if function.dated else {}
    for numbers in ([0.25, 0.5, 0.75], [1.0, 2.0, 3.0], [5.0, 5.0, 5.0]):
        for count in range(max(1, function.arity()[0]), len(function.parameters) + 1):
            kinds = [function.parameter(position).kind for position in range(count)]
            arguments = [np.array(numbers, bool if kind is Kind.LOGICAL else float) for kind in kinds]
            defaults = [p.default for p in function.parameters[count:] if not p.repeat]
            with np.errstate(all="ignore"):
                result = np.asarray(function.body(*arguments, *defaults, **dated))
            assert not any(np.shares_memory(result, argument) for argument in arguments)


@pytest.mark.parametrize(
    "formula",
    [
        'HYPERLINK("x",A1*2)',
        "TRANSPOSE(A1*2)",
        "+(A1*2)",
        "(A1*2)",
        "IFERROR(A1*2,0)",
        'IFNA(A1*2,"x")',
        "IF(A1>9,0,A1*2)",
    ],
)
def test_values_outlive_the_buffer_they_were_made_from(run, formula):
    cells = {"C1": f"={formula}", "C2": "=SQRT(A1)*3", "C3": "=C2+1", "C4": "=C1+C3"}
    assert run(cells, {"A1": [1.0, 4.0]}, ["C4"]).forecasts == [[6.0, 15.0]]


@pytest.mark.parametrize(
    ("item", "plain"),
    [(2.5, 2.5), (True, True), (False, False)],
)
def test_a_constant_as_steps_take_it(item, plain):
    result = plain_constant(constant(item))
    assert (type(result), result) == (type(plain), plain)


@pytest.mark.parametrize("item", ["x", None, ErrorCode.NA])
def test_any_other_constant_stays_a_value(item):
    value = constant(item)
    assert plain_constant(value) is value


@pytest.mark.parametrize(
    ("formula", "expected"),
    [
        ("(A1+A2)", {"A1", "A2"}),
        ("IFERROR(A1,A2)", {"A1"}),
        ("SUM(A1:A3)", {"A1", "A2", "A3"}),
        ("MAX(A1:A3,B1)", {"A1", "A2", "A3", "B1"}),
        ("SUM(A1:A1,C1)", {"A1", "C1"}),  # a logical does not count, yet may turn out an error
        ("IF(A1>0,A2,A3)", {"A2", "A3", "condition"}),
    ],
)
def test_what_a_step_reads(lower, formula, expected):
    lowering, (target,) = lower({"C1": "=1/A2>0", "Z9": f"={formula}"}, ["A1", "A2", "A3", "B1"], ["Z9"])
    names = {lowering.dag.input(name): name for name in ("A1", "A2", "A3", "B1")}
    names |= {lowering.cell(cell): "C1" for cell in lowering.graph.formulas if cell.a1 == "C1"}
    assert {names.get(node, "condition") for node in reads(lowering.dag, lowering.target(target))} == expected
