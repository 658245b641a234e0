"""Facts about a function stand in its row: a list of names elsewhere is a table of rules, and is known here."""

from __future__ import annotations

import ast
import re
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path

import pytest

from xlmc.engine.graph.called_functions import SPECIAL
from xlmc.engine.graph.choices import CHOICES
from xlmc.engine.graph.computed_references import REFERENCES
from xlmc.engine.graph.lambdas import LAMBDAS
from xlmc.engine.graph.lowering import WRITTEN_OUT
from xlmc.engine.graph.reference_functions import REFERENCE_FUNCTIONS
from xlmc.engine.graph.running_totals import FOLDS
from xlmc.engine.passes.bounds import _OF_ONE, _OF_SETS
from xlmc.engine.passes.derivatives.rules import RULES
from xlmc.engine.passes.exact import EXACT
from xlmc.excel.formula.callables import _CHOOSING
from xlmc.excel.formula.precedents import LOOKED_AT
from xlmc.excel.functions.facts import EmptyCells, Facts, Repeats
from xlmc.excel.functions.families import REGISTRY
from xlmc.excel.functions.lookup.search_and_pick import CELL_AT, POSITION
from xlmc.excel.functions.math.aggregate import SO_FAR
from xlmc.excel.functions.operators import ALL_BITS
from xlmc.excel.functions.values import constant
from xlmc.montecarlo.rare.inverse_image import FUNCTIONS, PERIODIC
from xlmc.montecarlo.rare.strata import _OF_AREAS

PACKAGE = Path(__file__).resolve().parents[3] / "xlmc"

ROWS = {row.name: row for row in REGISTRY.values()}
MADE = {"shown", "snap to zero", *(row.name for row in (*SO_FAR.values(), POSITION, CELL_AT))}
"""Rows that no formula calls by name."""

OURS = {*REGISTRY, *CHOICES, *REFERENCE_FUNCTIONS, *LAMBDAS, *WRITTEN_OUT, "LET", "LAMBDA", "RANDARRAY"}
NAMES = {name for name in OURS if name.isupper()}

_QUOTED = re.compile(r"(?=[\"']([^\"' \n]+)([\"' ]))")
"""A text, or the first word of one, and what ends it."""

LISTS = {
    ("engine/llvm/root_loop.py", "_EXACT"): "any other function's bits in native code are not NumPy's",
    ("montecarlo/model/forecast_values.py", "_KEEP_ONE_AND_ZERO"): "any other function may give more than 0 and 1",
    (
        "montecarlo/definitions/in_cells/random_functions.py",
        "INVERSES",
    ): "others of RAND() are computed from its draw",
    (
        "montecarlo/definitions/in_cells/random_functions.py",
        "_MAKING_ARRAYS",
    ): "any other function is asked for its rows and columns",
    ("engine/graph/circles.py", "_HIDING"): "any other function shows that a cell it reads is not there",
    ("engine/graph/circles.py", "_is_searched"): "what PICKING has",
    ("engine/graph/picked_ranges.py", "PICKING"): "any other function reads all cells of its ranges",
    ("engine/graph/picked_ranges.py", "_searched_cells"): "what PICKING has",
    ("engine/graph/choices.py", "CHOICES"): "any other function has all its arguments computed",
    ("engine/graph/called_functions.py", "SPECIAL"): "any other function takes as many arguments as its row says",
    ("engine/graph/lambdas.py", "LAMBDAS"): "any other function takes no LAMBDA",
    (
        "engine/graph/computed_references.py",
        "_CHOOSING",
    ): "any other function that gives a range is asked for its cells",
    (
        "engine/graph/reference_functions.py",
        "REFERENCE_FUNCTIONS",
    ): "any other function gets values",
    ("engine/graph/reference_functions.py", "_count"): "what REFERENCE_FUNCTIONS has",
    ("engine/graph/computed_references.py", "REFERENCES"): "any other function gives values, not references",
    ("engine/graph/number_lookups.py", "_FORMS"): "any other function is computed on values of any kind",
    ("engine/graph/constant_sums.py", "SUMS"): "any other function is no sum of a product's cells",
    ("engine/graph/running_totals.py", "FOLDS"): "any other function is computed of each range by itself",
    (
        "engine/graph/running_totals.py",
        "PAIRED_OR_COUNTED",
    ): "any other function of whole ranges is computed of each by itself",
    ("engine/graph/running_totals.py", "RunningTotals"): "what FOLDS has",
    ("engine/graph/whole_columns.py", "_look_up"): "any other lookup searches as MATCH does, or is refused",
    ("engine/graph/whole_columns.py", "_reach"): "any other lookup searches in both directions alike",
    ("engine/llvm/costs.py", "_SAVED_BY"): "any other function of numbers saves the usual time in a loop",
    ("engine/llvm/loop_rounding.py", "_FURTHER"): "any other function is computed by NumPy",
    ("engine/llvm/operations.py", "_ROWS"): "any other function is computed by NumPy",
    ("engine/llvm/sets.py", "_ROWS"): "any other function is computed by NumPy",
    ("engine/passes/bounds.py", "_OF_SETS"): "of any other set no bounds are known",
    ("engine/passes/bounds.py", "_OF_ONE"): "of any other function no bounds are known but those of its row",
    ("engine/passes/derivatives/conditions.py", "multiples"): "any other function is differentiated by differences",
    ("engine/passes/derivatives/conditions.py", "steps"): "any other function is differentiated by differences",
    ("engine/passes/derivatives/sums.py", "conditional"): "one rule's own",
    ("engine/passes/derivatives/sums.py", "variance"): "one rule's own",
    ("engine/passes/exact.py", "EXACT"): "any other function is computed as in the run, and told of as not checked",
    ("excel/formula/callables.py", "_CHOOSING"): "any other function gives no LAMBDA",
    ("excel/formula/precedents.py", "LOOKED_AT"): "any other function reads its arguments",
    ("excel/formula/stencil.py", "_leaves"): "formulas without LET and LAMBDA are filled down by their shape",
    ("excel/functions/math/rounding.py", "ceiling_precise"): "aliases of one row",
    ("excel/functions/math/aggregate.py", "RUNNING"): "no other function that goes on in a longer range overflows",
    ("excel/functions/math/aggregate.py", "SO_FAR"): "any other function is computed of each range by itself",
    ("outputs/replay/versions.py", "_AT_THE_ENDS"): "what changed in an earlier version",
    ("outputs/replay/versions.py", "_BESIDE"): "what changed in an earlier version",
    ("outputs/replay/versions.py", "_CHOICES"): "what changed in an earlier version",
    ("outputs/replay/versions.py", "_CRITERIA"): "what changed in an earlier version",
    ("outputs/replay/versions.py", "_DATABASE"): "what changed in an earlier version",
    ("montecarlo/rare/inverting.py", "Inverting"): "any other function is not undone: its filter is searched for",
    ("montecarlo/rare/inverse_image.py", "FUNCTIONS"): "any other function is not undone: its filter is searched for",
    ("montecarlo/rare/inverse_image.py", "PERIODIC"): "what FUNCTIONS has",
    ("montecarlo/rare/strata.py", "_OF_AREAS"): "any other function of an area makes no strata",
    (
        "analysis/studies/stability/rounding_errors.py",
        "_STEEP",
    ): "of others it is said that the argument is rounded",
    ("analysis/studies/stability/averaged_directions.py", "_MEANS"): "any other function is no mean of directions",
    ("analysis/studies/stability/averaged_directions.py", "_of_vectors"): "one form of a formula",
    ("analysis/studies/stability/edges.py", "_OVERFLOWS"): "the domains of others stand in their rows",
    ("analysis/studies/stability/momentum.py", "_arm"): "one form of a formula",
    ("analysis/studies/stability/momentum.py", "components"): "one form of a formula",
    ("analysis/studies/stability/rarer_forms.py", "_great_circle"): "one form of a formula",
    ("analysis/studies/stability/rarer_forms.py", "_without_bounds"): "one form of a formula",
    ("analysis/studies/stability/stable_forms.py", "LOGARITHMS"): "no other form is offered for any other function",
    ("analysis/studies/stability/stable_forms.py", "_of_logarithms"): "one form of a formula",
    ("analysis/studies/stability/stable_forms.py", "_of_squares"): "one form of a formula",
    ("excel/workbook/typed_values.py", "_LOGICALS"): "words for truth values, no functions",
    ("montecarlo/model/joining.py", "_OF_ONE_BOOK"): "any other function names cells of another workbook as well",
    ("engine/saved_values.py", "_PERIODIC"): "any other function must agree with what Excel saved",
}
"""(file, name or function) -> what holds of a function that is not in its lists of names."""


def _strings(node: ast.AST) -> list[str]:
    """The texts that a set, list, tuple, dict or split text is made of."""
    match node:
        case ast.Set(parts) | ast.List(parts) | ast.Tuple(parts) | ast.Dict(parts):
            return [part.value for part in parts if isinstance(part, ast.Constant) and isinstance(part.value, str)]
        case ast.Call(ast.Attribute(ast.Constant(str() as text), "split")):
            return text.split()
        case _:
            return []


def _owned(node: ast.AST, owner: str | None) -> Iterator[tuple[str, list[str]]]:
    """The lists below a node, each with the name at the top of the file that it belongs to."""
    for child in ast.iter_child_nodes(node):
        match child:
            case ast.FunctionDef(name) | ast.ClassDef(name) if owner is None:
                own: str | None = name
            case ast.Assign([target]) | ast.AnnAssign(target) | ast.AugAssign(target) if owner is None:
                own = ast.unparse(target)
            case _:
                own = owner
        if (result := _strings(child)) and own is not None and own != "__all__":
            yield own, result
        yield from _owned(child, own)


def _lists(source: str) -> dict[str, list[list[str]]]:
    """By name: the lists in a file that hold two names of functions, or more."""
    named = {(name, end) for name, end in _QUOTED.findall(source) if name in NAMES}
    if len({name for name, _ in named}) < 2 and all(end != " " for _, end in named):
        return {}  # which spares parsing most files
    result = defaultdict(list)
    for owner, names in _owned(ast.parse(source), None):
        if len(NAMES.intersection(names)) > 1:
            result[owner].append(names)
    return result


@pytest.fixture(scope="module")
def lists():
    return {
        (path.relative_to(PACKAGE).as_posix(), owner): names
        for path in sorted(PACKAGE.rglob("*.py"))
        for owner, names in _lists(path.read_text(encoding="utf-8")).items()
    }


def test_a_list_would_be_found():
    source = (
        "A = 1\nB: Final = frozenset({'SUM', 'MAX'} | {'NO', 'MIN'})\ndef f():\n    return 'SORT TAKE DROP'.split()"
    )
    assert _lists(source) == {"B": [["SUM", "MAX"]], "f": [["SORT", "TAKE", "DROP"]]}


def test_there_are_no_lists_of_functions_but_tables_of_rules(lists):
    """A fact belongs into `xlmc.excel.functions.facts`, and into the rows; a table of rules is written into `LISTS`."""
    assert set(lists) - set(LISTS) == set(), "write it as a fact of the rows, or into LISTS"
    assert set(LISTS) - set(lists) == set()


def test_every_name_in_them_is_that_of_a_function(lists):
    """One that was renamed fails here by its name."""
    named = re.compile(r"[A-Z][A-Z0-9.]+")
    unknown = {name for names in lists.values() for part in names for name in part if named.fullmatch(name)} - OURS
    assert unknown == set()


@pytest.mark.parametrize("table", [EXACT, RULES, _OF_ONE, _OF_SETS], ids=["exact", "derivatives", "one", "sets"])
def test_tables_of_nodes_have_the_names_of_rows(table):
    """An alias would never be looked up."""
    assert set(table) - set(ROWS) - MADE == set()


def test_tables_of_native_code_have_the_names_of_rows():
    operations, sets, rounding = (
        pytest.importorskip("xlmc.engine.llvm.operations"),
        pytest.importorskip("xlmc.engine.llvm.sets"),
        pytest.importorskip("xlmc.engine.llvm.loop_rounding"),
    )
    assert {*operations._ROWS, *sets._ROWS, *rounding.ROUNDED} - set(ROWS) - MADE == set()
    assert all(ROWS[name].takes_sets for name in sets._ROWS)


@pytest.mark.parametrize("table", [FUNCTIONS, _OF_AREAS, FOLDS], ids=["inverse image", "switches", "running totals"])
def test_tables_of_formulas_have_all_names_of_a_row(table):
    """A formula may call a function by any of them."""
    rows = {REGISTRY[name] for name in table}
    assert {name for name, row in REGISTRY.items() if row in rows and name.isupper()} <= set(table)


def test_lists_of_choices_and_of_places_agree():
    assert CHOICES.keys() - {"SINGLE"} == _CHOOSING
    assert set(LOOKED_AT) <= REFERENCE_FUNCTIONS.keys()
    assert REFERENCES.keys() <= REFERENCE_FUNCTIONS.keys() | CHOICES.keys()
    assert {*CHOICES, *REFERENCE_FUNCTIONS, *LAMBDAS, *WRITTEN_OUT} - SPECIAL.keys() <= REGISTRY.keys()
    assert set(PERIODIC) <= FUNCTIONS.keys()


def test_comparisons_to_the_last_bit_state_what_the_others_do():
    assert {name: row.facts for name, row in ALL_BITS.items()} == {name: REGISTRY[name].facts for name in ALL_BITS}


FEW = {
    "what spills": ({"SORT", "MMULT", "INDEX", "XLOOKUP", "LINEST"}, lambda facts: facts.spills),
    "what its numbers size": ({"TAKE", "SEQUENCE"}, lambda facts: facts.sized_by_numbers),
    "what looks up": ({"MATCH", "XLOOKUP", "LOOKUP"}, lambda facts: facts.mode_argument is not None),
    "what is bounded": ({"SIN", "COS", "TANH"}, lambda facts: facts.result_range is not None),
    "what has a domain": ({"SQRT", "LN", "ACOS"}, lambda facts: facts.domain is not None),
    "what ignores empty cells": ({"SUM", "NPV"}, lambda facts: facts.empty_cells is EmptyCells.IGNORED),
    "what adds up": ({"SUM", "COUNT", "SUMSQ"}, lambda facts: facts.repeats is Repeats.ADD_UP),
}


@pytest.mark.parametrize(("names", "holds"), FEW.values(), ids=FEW)
def test_facts_are_stated(names, holds):
    assert {name for name, row in ROWS.items() if holds(row.facts)} >= names
    assert not holds(Facts())


def test_a_lookup_says_how_by_an_argument_that_it_has_or_always_looks_up_by_halves():
    message = {name: row.facts.mode_argument for name, row in ROWS.items() if row.facts.mode_argument is not None}
    assert {name for name, argument in message.items() if argument >= ROWS[name].arity()[1]} == {"LOOKUP"}


def test_what_lies_between_two_numbers_does():
    for row in ROWS.values():
        if row.facts.result_range is not None:
            low, high = row.facts.result_range
            result = [row([constant(x)]).numbers[0] for x in (-1e5, -2.0, 0.0, 0.5, 1.5, 4.7, 700.0)]
            assert low <= min(result)
            assert max(result) <= high


def test_a_function_with_a_domain_is_an_error_beyond_it_and_a_number_within():
    for row in ROWS.values():
        domain = row.facts.domain
        if domain is not None:
            end = row([constant(domain.low)])
            assert end.has_errors is not domain.with_ends or row.name == "ATANH", row.name
            assert row([constant(domain.low - 0.01)]).has_errors
            assert not row([constant(domain.low + 0.01)]).has_errors
