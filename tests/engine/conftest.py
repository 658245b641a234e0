"""Formulas lowered and run on draws of the test's own; the fast path always beside the careful one."""

from __future__ import annotations

import importlib.util
from dataclasses import dataclass

import numpy as np
import pytest

from xlmc.engine.engine import BLANK_RESULT, TEXT_RESULT, Target
from xlmc.engine.engines import ENGINES
from xlmc.engine.graph.lowering import Lowering, lower_until_complete
from xlmc.engine.numpy import numpy_engine as module
from xlmc.engine.numpy.numpy_engine import NumpyProgram
from xlmc.errors import ErrorCode
from xlmc.excel.address import parse_address
from xlmc.excel.formula import Resolver, build_graph


@dataclass
class Outcome:
    """One run: filters and forecasts as lists of Python objects a trial, and whether the block left the fast path."""

    filters: list[list[object]]
    forecasts: list[list[object]]
    careful: bool
    program: NumpyProgram


def _objects(column):
    codes = np.zeros(column.values.size, int) if column.codes is None else column.codes
    texts = {TEXT_RESULT: "text", BLANK_RESULT: "blank"}
    return [
        float(value) if code == 0 else texts.get(int(code)) or ErrorCode(int(code)).text
        for value, code in zip(column.values, codes, strict=True)
    ]


def _bits(column):
    """Numbers to the bit, but for the sign of zero, which Excel does not have; codes."""
    codes = np.zeros(column.values.size, int) if column.codes is None else column.codes.astype(int)
    numbers = np.where(codes > 0, 0.0, column.values.astype(float)) + 0.0
    return numbers.view(np.int64).tolist(), codes.tolist()


def _evaluate(evaluator, draws, n):
    filters = [(_bits(column), _objects(column)) for column in evaluator.filters(draws, n)]
    survivors = np.flatnonzero([all(objects[i] == 1.0 for _, objects in filters) for i in range(n)])
    late = evaluator.forecasts(survivors) if survivors.size else []
    return filters, [(_bits(column), _objects(column)) for column in late]


@pytest.fixture(scope="session")
def evaluate():
    """`evaluate(evaluator, draws, n)`: the bits and the values of all columns, filters first."""
    return _evaluate


@pytest.fixture(scope="session")
def lower(workbook):
    """`lower(cells, inputs, targets)`: the lowered graph; inputs and targets are addresses, `held` are held cells."""

    def make(cells, inputs, targets, held=None, **of_workbook):
        book = workbook(cells, **of_workbook)
        names = {parse_address(address, "S"): address for address in inputs}
        held = {parse_address(address, "S"): value for address, value in (held or {}).items()}
        result = [parse_address(address, "S") for address in targets]

        def lowered(more):
            graph = build_graph(Resolver(book, names), result, frozenset(names), frozenset(held), more=more)
            return Lowering(graph, names, held)

        return lower_until_complete(lowered), [Target(cell, cell) for cell in result]

    return make


@pytest.fixture(scope="session")
def run(lower):
    """`run(cells, {"A1": draws}, forecasts, filters)`: the outcome, once the fast path was seen to equal the careful.

    A filter's cell must be 1 or TRUE. Draws that are NaN are errors.
    """

    def compare(cells, draws, forecasts, filters=(), **of_workbook):
        draws = {address: np.asarray(values, float) for address, values in draws.items()}
        n = len(next(iter(draws.values())))
        lowering, targets = lower(cells, draws, [*filters, *forecasts], **of_workbook)
        first, late = targets[: len(filters)], targets[len(filters) :]
        program = NumpyProgram.of(lowering, first, late, frozenset(draws))
        evaluator = program.evaluator(n)
        fast = _evaluate(evaluator, draws, n)
        nodes = [lowering.target(target) for target in targets]
        slow = module.TrackingEvaluator(lowering.dag, nodes[: len(filters)], nodes[len(filters) :])
        assert fast == _evaluate(slow, draws, n)
        left = evaluator._left_fast_path or bool(evaluator._tracking._values)
        return Outcome([o for _, o in fast[0]], [o for _, o in fast[1]], left, program)

    return compare


@pytest.fixture(scope="session")
def value(run):
    """What one formula gives, with `A1` drawn to be that number: the other cells lie around it."""

    def evaluate(formula, a1=1.0, **cells):
        outcome = run({"A1": 0.0, **cells, "Z9": formula}, {"A1": [a1]}, ["Z9"])
        return outcome.forecasts[0][0]

    return evaluate


def _plain(item):
    """As a column of results has it: logicals as numbers, errors by their text."""
    if isinstance(item, bool):
        return float(item)
    return item.text if isinstance(item, ErrorCode) else item


@pytest.fixture(scope="session")
def load_program():
    """`load_program(engine, in_vectors)`: what makes its program; of `jit` the loops, also where they do not pay.

    These take one trial after another, which gives the same numbers and is compiled sooner, unless `in_vectors`: of
    fewer than 16 trials a loop would put none into a vector. Then they take one vector after another.
    """

    def load(engine, in_vectors=False):
        if engine != "jit":
            return ENGINES[engine].load()
        from xlmc.engine.llvm import phase
        from xlmc.engine.llvm.loop import compile_loop
        from xlmc.engine.llvm.program import JitProgram

        def made(*given):
            with pytest.MonkeyPatch.context() as patch:
                patch.setattr(phase, "compile_loop", lambda *asked: compile_loop(*asked[:6], int(in_vectors)))
                return JitProgram(*given)

        return made

    return load


WAYS = ["constants", "numpy", *(["jit"] if importlib.util.find_spec("llvmlite") else [])]


@pytest.fixture(scope="session")
def ways(lower, load_program):
    """`ways(cells, formulas)`: what each formula gives from constants, and from assumptions of zero width in engines.

    Every number among the cells is such an assumption, but for those in `held`. A formula is a text, which lies in
    column Z of sheet S beside nothing, or a pair of its address and its text.
    """

    def compute(cells, formulas, held=(), **of_workbook):
        placed = [f if isinstance(f, tuple) else (f"Z{100 + i}", f) for i, f in enumerate(formulas)]
        book = cells | {address: f"={text}" for address, text in placed}
        targets = [address for address, _ in placed]
        lowering, result = lower(book, {}, targets, **of_workbook)
        known = [lowering.known(target) for target in result]
        answers = {"constants": [_plain(value.objects().ravel()[0]) for value in known]}
        drawn = {a: v for a, v in cells.items() if type(v) in (int, float) and a not in held}
        draws = {address: np.full(3, float(value)) for address, value in drawn.items()}
        lowering, result = lower(book, draws, targets, **of_workbook)
        for way in WAYS[1:]:
            program = load_program(way)(lowering, [], result, frozenset(draws))
            evaluator = program.evaluator(3)
            list(evaluator.filters(draws, 3))
            columns = [_objects(column) for column in evaluator.forecasts(np.arange(3))]
            assert all(len(set(map(str, column))) == 1 for column in columns)
            answers[way] = [column[0] for column in columns]
        return answers

    return compute


@pytest.fixture(scope="session")
def trials(lower, load_program):
    """`trials(cells, formula, draws, engines)`: what it gives for each number in A1, as a constant and drawn."""

    def compute(cells, formula, draws, engines=WAYS[1:], *, constants=True):
        answers, n = {}, len(draws)
        if constants:
            asked = {f"Z{row}": f"={formula.replace('A1', repr(draw))}" for row, draw in enumerate(draws, 100)}
            lowering, result = lower(cells | asked, {}, asked)
            answers["constants"] = [_plain(lowering.known(target).objects().ravel()[0]) for target in result]
        lowering, result = lower(cells | {"A1": 0.0, "Z9": f"={formula}"}, ["A1"], ["Z9"])
        for way in engines:
            evaluator = load_program(way)(lowering, [], result, frozenset()).evaluator(n)
            list(evaluator.filters({"A1": np.array(draws)}, n))
            answers[way] = _objects(evaluator.forecasts(np.arange(n))[0])
        return answers

    return compute


@pytest.fixture(scope="session")
def gives(ways):
    """`gives(cells, table)`: what differs from a table of formula -> value, as a list of lines."""

    def compare(cells, table, held=(), **of_workbook):
        result = ways(cells, [formula for formula, _ in table], held, **of_workbook)
        lines = []
        for way, answers in result.items():
            for (formula, expected), got in zip(table, answers, strict=True):
                wanted = _plain(expected)
                wanted = "text" if isinstance(wanted, str) and way != "constants" and wanted[:1] != "#" else wanted
                same = got == wanted if isinstance(wanted, str) or isinstance(got, str) else abs(got - wanted) < 1e-12
                if not same:
                    lines.append(f"{way}: {formula} gives {got!r}, not {wanted!r}")
        return lines

    return compare
