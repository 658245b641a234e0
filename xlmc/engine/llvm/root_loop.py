"""The search for roots of `engine.roots` as one loop over trials: scan, interpolation, and all evaluations between.

The loop takes the trials in which the scan meets one change of sign, and no 0, and the interpolations converge.
It computes what `find_roots` does, in the same order, and so gives the same bits. All other trials, those in which
anything may be an error among them, are left to it.
"""

from __future__ import annotations

import ctypes
from collections.abc import Mapping, Sequence
from typing import Any, Final

import numpy as np
from llvmlite import ir
from numpy.typing import NDArray

from xlmc.engine.graph.graph import Dag
from xlmc.engine.graph.nodes import Apply, Constant, Input, Select
from xlmc.engine.llvm.body import Body, Loaded, contexts
from xlmc.engine.llvm.loop import loop_over_trials, write_entry
from xlmc.engine.llvm.loop_arithmetic import intrinsic
from xlmc.engine.llvm.loop_rules import LoopRule, Operand, reads
from xlmc.engine.llvm.machine import machine
from xlmc.engine.llvm.operations import loop_rule_of
from xlmc.engine.numpy.repeated import RepeatedProgram
from xlmc.engine.roots import CONVERGED, EPSILON, INTERPOLATIONS, OWN_STEPS, SCANNED
from xlmc.excel.functions import Kind
from xlmc.excel.functions.fifteen_digits import SNAP_TO_ZERO

__all__ = ["RootLoop", "root_loop"]

_MOST_NODES: Final = 64
"""Nodes that depend on the unknown. The code has all of them once for each point of the scan and each step."""

_EXACT: Final = frozenset(
    ("+", "-", "*", "/", "u-", "%", SNAP_TO_ZERO.name, "ABS", "SQRT", "INT", "MIN", "MAX", "SUM", "NOT", "AND", "OR")
) | frozenset(("=", "<>", "<", "<=", ">", ">="))
"""Functions whose bits are those of the engine `numpy`."""

_LONG, _BYTE, _BIT, _DOUBLE = ir.IntType(64), ir.IntType(8), ir.IntType(1), ir.DoubleType()

Floats = NDArray[np.float64]


class RootLoop:
    """Native code that solves for the input of a program; `root_loop` makes it.

    Args:
        program: its two targets are to be equal.
        rules: how loops compute the nodes that depend on the input.
    """

    def __init__(self, program: RepeatedProgram, rules: Mapping[int, LoopRule]) -> None:
        self._names = program.inputs
        module = ir.Module()
        _write(module, program, rules)
        self._code = machine().native(module, "over_trials")

    def __call__(self, given: Mapping[str, Floats], low: Floats, high: Floats) -> tuple[Floats, NDArray[np.bool_]]:
        """Return the roots, and the trials that have one, `(n,)` each; in all others nothing is known.

        Args:
            given: what the program reads beside the unknown, `(n,)` each.
            low: `(n,)` the lower end of each trial's range; NaN for a trial without one.
            high: `(n,)` the upper end.
        """
        roots, values = np.empty(low.size), np.zeros(low.size, np.uint8)
        columns = [np.ascontiguousarray(each) for each in (low, high, *(given[name] for name in self._names))]
        addresses = [each.ctypes.data for each in (*columns, roots, values)]
        self._code((ctypes.c_void_p * len(addresses))(*addresses), low.size)
        return roots, values.view(np.bool_)


def root_loop(program: RepeatedProgram) -> RootLoop | None:
    """Compile the search for the input at which the two targets of a program are equal.

    Return None if a node between them is not computed by loops, or not to the same bits, or there are many.
    """
    rules = _rules(program.dag, program.targets)
    return None if rules is None else RootLoop(program, rules)


def _rules(dag: Dag, targets: Sequence[int]) -> dict[int, LoopRule] | None:
    rules: dict[int, LoopRule] = {}

    def read(node: int) -> tuple[int, ...]:
        rule = None if isinstance(dag.nodes[node], Input) else loop_rule_of(dag, node)
        if rule is not None:
            rules[node] = rule
        return reads(dag, node, rule)

    needed = [node for node in dag.upstream(targets, read) if not isinstance(dag.nodes[node], Input)]
    fine = len(needed) <= _MOST_NODES and all(node in rules and _is_exact(dag, node) for node in needed)
    numbers = all(dag.types[node] is Kind.NUMBER and dag.sizes[node] is None for node in targets)
    return {node: rules[node] for node in needed} if fine and numbers else None


def _is_exact(dag: Dag, node_id: int) -> bool:
    node = dag.nodes[node_id]
    return isinstance(node, Select) or (isinstance(node, Apply) and node.function.name in _EXACT)


def _write(module: ir.Module, program: RepeatedProgram, rules: Mapping[int, LoopRule]) -> None:
    """Write the loop: it reads both ends of the range and the inputs, and writes roots and whether they are some."""
    arrays = [Kind.NUMBER] * (len(program.inputs) + 3) + [Kind.LOGICAL]

    def trial(builder: ir.IRBuilder, pointers: Sequence[Any], i: Any) -> None:
        *read, roots, value = (builder.gep(pointer, [i]) for pointer in pointers)
        low, high, *given = map(builder.load, read)
        known = dict(zip(program.inputs, given, strict=True))
        root, solved = _Search(program, rules, builder, known).root(low, high)
        builder.store(root, roots)
        builder.store(builder.zext(solved, _BYTE), value)

    write_entry(module, loop_over_trials(module, arrays, trial), machine())


class _Search:
    """Emits the search in one trial. All of it is straight, so that the loop computes several trials at once."""

    def __init__(
        self, program: RepeatedProgram, rules: Mapping[int, LoopRule], builder: Any, given: Mapping[str, Any]
    ) -> None:
        self._program, self._rules, self._builder = program, rules, builder
        self._given = given
        self._contexts = contexts(program.dag, rules, program.targets)
        self._wrong: Any = _BIT(0)

    def root(self, low: Any, high: Any) -> tuple[Any, Any]:
        """Emit the scan and the steps; gives the root, and whether it is one."""
        b, zero = self._builder, _DOUBLE(0.0)
        width = b.fsub(high, low)
        at, before = low, self._difference(low)
        fine, crossings = b.and_(b.fcmp_ordered("<=", low, high), b.fcmp_ordered("!=", before, zero)), _LONG(0)
        positive = b.fcmp_ordered(">", before, zero)
        ends = low, high, before, before
        for part in range(1, SCANNED + 1):
            left, at = at, high if part == SCANNED else b.fadd(low, b.fmul(width, _DOUBLE(part / SCANNED)))
            value = self._difference(at)
            fine = b.and_(fine, b.fcmp_ordered("!=", value, zero))
            above = b.fcmp_ordered(">", value, zero)
            here = b.xor(above, positive)
            crossings = b.add(crossings, b.zext(here, _LONG))
            ends = tuple(b.select(here, new, old) for new, old in zip((left, at, before, value), ends, strict=True))
            before, positive = value, above
        fine = b.and_(fine, b.icmp_unsigned("==", crossings, _LONG(1)))
        result, solved = self._interpolate(*ends)
        return result, b.and_(b.and_(fine, solved), b.not_(self._wrong))

    def _interpolate(self, low: Any, high: Any, f0: Any, f1: Any) -> tuple[Any, Any]:
        """Emit the steps, as `roots._solve` goes through them."""
        b, zero = self._builder, _DOUBLE(0.0)
        small = b.fmul(_DOUBLE(CONVERGED), self._of("minnum", self._of("fabs", f0), self._of("fabs", f1)))
        x1, before = high, b.fsub(high, low)
        slope = b.fdiv(before, b.fsub(f1, f0))
        x = b.fsub(x1, b.fmul(f1, slope))
        value, solved = x, _BIT(0)
        for step in range(INTERPOLATIONS):
            x = self._of("minnum", self._of("maxnum", x, low), high)
            fx = self._difference(x, unless=solved)
            moved = b.fsub(x, x1)
            slope_before, slope = slope, b.fdiv(moved, b.fsub(fx, f1))
            bend = b.fdiv(b.fsub(slope, slope_before), b.fsub(fx, f0))
            change = b.fmul(b.fsub(slope, b.fmul(bend, f1)), fx)
            size, last = self._of("fabs", change), b.fmul(_DOUBLE(EPSILON), self._of("fabs", x))
            most, exact = self._of("fabs", moved), b.fcmp_ordered("==", fx, zero)
            crossed = b.xor(b.fcmp_ordered(">", fx, zero), b.fcmp_ordered(">", f1, zero))
            done = b.and_(crossed, b.fcmp_ordered("<=", most, b.fmul(_DOUBLE(4.0), last)))
            if step >= OWN_STEPS:
                square = b.fmul(b.fmul(_DOUBLE(16.0), size), size)
                done = b.or_(done, b.fcmp_ordered("<=", square, b.fmul(last, before)))
            done = b.and_(b.or_(done, exact), b.fcmp_ordered("<=", self._of("fabs", fx), small))
            most = b.select(exact, zero, most)
            nearer = self._of("minnum", self._of("maxnum", change, b.fneg(most)), most)
            value = b.select(solved, value, b.fsub(x, nearer))
            solved = b.or_(solved, done)
            least = b.fmul(_DOUBLE(2.0), last)
            size = b.select(b.fcmp_unordered(">", size, least), size, least)
            x1, f0, f1, before = x, f1, fx, size
            x = b.fsub(x1, self._of("copysign", size, change))
        return value, solved

    def _difference(self, at: Any, unless: Any = None) -> Any:
        """Emit the difference of the targets; note where anything may be wrong, unless it does not matter there."""
        program, dag = self._program, self._program.dag
        nodes = dag.upstream(program.targets, lambda node: reads(dag, node, self._rules.get(node)))
        inputs = {node: each.name for node in nodes if isinstance(each := dag.nodes[node], Input)}
        given = {**self._given, program.changing: at}
        loaded = {Operand(node, Kind.NUMBER): Loaded(given[name], False) for node, name in inputs.items()}
        body = Body(dag, self._builder, loaded, self._contexts, machine(), {})
        for node, rule in self._rules.items():
            body.compute(node, rule)
        value, to = (self._result(body, node) for node in program.targets)
        wrong = body.wrong()
        if wrong is not None:
            counts = wrong if unless is None else self._builder.and_(wrong, self._builder.not_(unless))
            self._wrong = self._builder.or_(self._wrong, counts)
        return self._builder.fsub(value, to)

    def _result(self, body: Body, node_id: int) -> Any:
        node = self._program.dag.nodes[node_id]
        return _DOUBLE(float(node.value.numbers[0])) if isinstance(node, Constant) else body.result(node_id)

    def _of(self, name: str, *arguments: Any) -> Any:
        return intrinsic(self._builder, _DOUBLE, f"llvm.{name}", *arguments)
