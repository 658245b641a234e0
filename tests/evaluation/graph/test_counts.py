"""Every function with too few, too many, empty and missing arguments: a value, or a refusal with its cell."""

from __future__ import annotations

import numpy as np
import pytest

from xlmc.address import parse_address
from xlmc.errors import FormulaError, XlmcError
from xlmc.evaluation.engine import Target
from xlmc.evaluation.graph.choices import CHOICES
from xlmc.evaluation.graph.counts import MOST, SPECIAL, check_count
from xlmc.evaluation.graph.lambdas import LAMBDAS
from xlmc.evaluation.graph.lower import Lowering
from xlmc.evaluation.graph.places import PLACES
from xlmc.evaluation.graph.written_out import WRITTEN_OUT
from xlmc.evaluation.numpy.numpy_engine import NumpyProgram
from xlmc.formula import Resolver, build_graph
from xlmc.functions.families import REGISTRY

OURS = sorted(name for name in {*REGISTRY, *CHOICES, *PLACES, *LAMBDAS, *WRITTEN_OUT} if name[0].isalpha())
CELLS = {"A1": 0.0, "A2": 2.0, "A3": "x", "B1": 1.5, "B2": True, "C1": 3.0, "C2": "=1/0", "C3": "=A1*2"}

LOST = ['INDIRECT("no such")', "OFFSET(A1,-1,0)", "INDEX(A1:B2,9,9)", "INDEX(A1:B2,A1+2,1)", "CHOOSE(9,A1:A2,B1:B2)"]
"""References that lead nowhere; the fourth in some trials only."""


def _limits(name):
    return SPECIAL[name] if name in SPECIAL else REGISTRY[name].arity()


@pytest.fixture(scope="module")
def outcome(workbook):
    """`outcome("SUM(A1)")`: the codes of three trials, the last of an error; the message where it is refused."""

    def compute(formula):
        book = workbook({**CELLS, "Z9": f"={formula}"})
        inputs, cell = {parse_address("A1", "S"): "A1"}, parse_address("Z9", "S")
        try:
            graph = build_graph(Resolver(book, inputs), [cell], frozenset(inputs), frozenset())
            program = NumpyProgram.of(Lowering(graph, inputs, {}), [], [Target(cell, cell)], frozenset(["A1"]))
        except XlmcError as error:
            return str(error)
        evaluator = program.evaluator(3)
        evaluator.filters({"A1": np.array([1.0, 2.0, np.nan])}, 3)
        (column,) = evaluator.forecasts(np.arange(3))
        return np.zeros(3, int) if column.codes is None else column.codes.astype(int)

    return compute


@pytest.mark.parametrize("name", OURS)
def test_a_wrong_number_of_arguments_is_refused_with_the_cell(outcome, name):
    fewest, most = _limits(name)
    for count in {max(fewest - 1, 0), most + 1} - {fewest}:
        refused = outcome(f"{name}({','.join(['1'] * count)})")
        assert isinstance(refused, str)
        assert "S!Z9" in refused


@pytest.mark.parametrize(("place", "name"), list(enumerate(OURS)))
def test_any_arguments_give_values_or_a_refusal_with_the_cell(outcome, place, name):
    count = max(_limits(name)[0], 1)
    for part in ("", "A1:B3", "{1,2;3,4}", LOST[place % len(LOST)]):
        found = outcome(f"{name}({','.join([part] * count)})")
        assert "S!Z9" in found if isinstance(found, str) else found.shape == (3,)


def test_a_count_that_is_wrong_says_what_is_right():
    with pytest.raises(FormulaError, match="INDIRECT has 0 arguments; it takes 1 to 2"):
        check_count("INDIRECT", ())
    with pytest.raises(FormulaError, match="MAP has 1 argument; it takes 2 or more"):
        check_count("MAP", (1,))
    check_count("NOSUCH", ())


def test_every_function_that_is_lowered_in_a_way_of_its_own_has_a_count():
    special = {*CHOICES, *PLACES, *LAMBDAS, *WRITTEN_OUT}
    assert special - SPECIAL.keys() <= REGISTRY.keys()
    assert all(0 <= fewest <= most <= MOST for fewest, most in SPECIAL.values())
