"""One trial's computation in a loop: values of nodes, and what went wrong so far, by context.

The loop computes both branches of every `IF`; what goes wrong in one counts only in the trials that take it. These
trials are the branch's context. A node that is needed in several contexts belongs to the narrowest that holds them all.

What went wrong is kept in two ways. A number that may be infinite or NaN is multiplied by 0 and added to a running sum
before its trace is lost (in a comparison, a divisor, in memory); if it was one, the sum is NaN from then on. That costs
one fused instruction. An error of Excel that leaves no trace in arithmetic is a flag.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from llvmlite import ir

from xlmc.engine.graph.graph import Dag
from xlmc.engine.graph.nodes import Select
from xlmc.engine.graph.trial_sets import ALL_TRIALS, DEEPEST_BRANCHES, TrialSet, common_set
from xlmc.engine.llvm.loop_arithmetic import Arithmetic, intrinsic, sine_and_cosine
from xlmc.engine.llvm.loop_rules import Literal, LoopRule, Operand, reads
from xlmc.engine.llvm.machine import Machine
from xlmc.excel.functions import Kind
from xlmc.excel.functions.denormals import TINIEST

__all__ = ["Body", "Loaded", "contexts"]

_BIT = ir.IntType(1)


@dataclass(frozen=True, slots=True)
class Loaded:
    """A value that the loop reads from memory, a double or a truth value, and whether it may be infinite or NaN."""

    value: Any
    fallible: bool


class Body:
    """Emits nodes one after another.

    Args:
        loaded: the nodes from outside the loop, each as its own kind or, if the loop has no such kind, as one it has.
        contexts: of the nodes of the loop.
        machine: the processor.
        numbers: (node, position of an operand) -> its value, for constants that are not part of the code.

    Attributes:
        builder: where instructions go.
        real: the type of numbers.
    """

    def __init__(
        self,
        dag: Dag,
        builder: Any,
        loaded: Mapping[Operand, Loaded],
        contexts: Mapping[int, TrialSet],
        machine: Machine,
        numbers: Mapping[tuple[int, int], Any],
    ) -> None:
        self.builder: Any = builder
        self.real: Any = ir.DoubleType()
        self._dag, self._contexts, self._fused = dag, contexts, machine.fused
        self._flushes = machine.flushes
        self._known = dict(loaded)
        self._numbers = numbers
        self._checked: set[tuple[Operand, TrialSet]] = set()
        self._sums: dict[TrialSet, Any] = {}
        self._flags: dict[TrialSet, Any] = {}
        self._sines_and_cosines: dict[int, tuple[Any, tuple[Any, Any]]] = {}
        self._context = ALL_TRIALS

    def number(self, value: float) -> Any:
        """Make a constant."""
        return ir.Constant(self.real, value)

    def truth(self, value: bool) -> Any:
        """Make a constant truth value."""
        return ir.Constant(_BIT, int(value))

    def intrinsic(self, name: str, *arguments: Any) -> Any:
        """Call one of LLVM's own functions of numbers."""
        return intrinsic(self.builder, self.real, name, *arguments)

    def of_doubles(self, function: Callable[..., Any], *arguments: Any) -> Any:
        """Emit a function that is made of arithmetic."""
        return function(Arithmetic(self.builder, self._fused), *arguments)

    def sine_and_cosine(self, angle: Any) -> tuple[Any, Any]:
        """Emit the sine and the cosine of an angle, once for each angle."""
        if id(angle) not in self._sines_and_cosines:
            self._sines_and_cosines[id(angle)] = angle, sine_and_cosine(self.builder, angle, self._fused)
        return self._sines_and_cosines[id(angle)][1]

    def flag(self, wrong: Any) -> None:
        """Have the trial computed again where `wrong` holds, if it needs the node at hand."""
        so_far = self._flags.get(self._context)
        self._flags[self._context] = wrong if so_far is None else self.builder.or_(so_far, wrong)

    def compute(self, node: int, rule: LoopRule) -> None:
        """Emit a node whose operands were emitted or loaded."""
        self._context = self._contexts.get(node, ALL_TRIALS)
        values, fallible = [], rule.makes
        for position, part in enumerate(rule.operands):
            if isinstance(part, Operand):
                if position in rule.absorbs or self._is_truth_of_number(part):
                    self._check(part)
                else:
                    fallible = fallible or self._source(part)[1].fallible
            number = self._numbers.get((node, position))
            values.append(self._value(part) if number is None else number)
        for part in rule.beside:
            self._check(part)
        value = self.flush(rule.emit(self, values))
        own = Operand(node, self._dag.types[node])
        self._known[own] = Loaded(value, fallible and own.kind is Kind.NUMBER)
        if isinstance(self._dag.nodes[node], Select):
            self._join(node, values[0])

    def flush(self, value: Any) -> Any:
        """0 instead of a number too small for Excel, where the processor does not see to it."""
        if self._flushes or value.type != self.real:
            return value
        tiny = self.builder.fcmp_ordered("<", self.intrinsic("llvm.fabs", value), self.number(TINIEST))
        return self.builder.select(tiny, self.number(0.0), value)

    def result(self, node: int) -> Any:
        """Return a node's value as it leaves the loop."""
        self._context = ALL_TRIALS
        own = Operand(node, self._dag.types[node])
        self._check(own)
        return self._value(own)

    def wrong(self) -> Any:
        """Whether the trial must be computed again; None if none ever needs to be."""
        total, flag = self._sums.get(ALL_TRIALS), self._flags.get(ALL_TRIALS)
        if total is None:
            return flag
        lost = self.builder.fcmp_unordered("uno", total, total)
        return lost if flag is None else self.builder.or_(lost, flag)

    def _source(self, part: Operand) -> tuple[Operand, Loaded]:
        """Return the place of the operand's value, and the kind that it has there."""
        if part not in self._known:
            part = Operand(part.node, self._dag.types[part.node])
        return part, self._known[part]

    def _value(self, part: Operand | Literal) -> Any:
        if isinstance(part, Literal):
            return self.truth(part.value) if isinstance(part.value, bool) else self.number(part.value)
        value = self._source(part)[1].value
        is_number = value.type == self.real
        if part.kind is Kind.NUMBER:
            return value if is_number else self.builder.uitofp(value, self.real)
        return self.builder.fcmp_unordered("!=", value, self.number(0.0)) if is_number else value

    def _is_truth_of_number(self, part: Operand) -> bool:
        """Whether taking a number as a truth value hides that it is infinite or NaN."""
        return part.kind is Kind.LOGICAL and bool(self._source(part)[1].value.type == self.real)

    def _check(self, part: Operand) -> None:
        """Add a number that may be infinite or NaN to the running sum, once; the module's docstring says why."""
        node, loaded = self._source(part)
        if not loaded.fallible or any((node, context) in self._checked for context in self._context.outwards()):
            return
        self._checked.add((node, self._context))
        self._add(loaded.value)

    def _add(self, value: Any) -> None:
        zero, so_far = self.number(0.0), self._sums.get(self._context)
        if so_far is None:
            self._sums[self._context] = self.builder.fmul(value, zero)
        elif self._fused:
            self._sums[self._context] = self.intrinsic("llvm.fma", value, zero, so_far)
        else:
            self._sums[self._context] = self.builder.fadd(self.builder.fmul(value, zero), so_far)

    def _join(self, node: int, condition: Any) -> None:
        """Let what went wrong in a branch count in the context around it, in the trials that take the branch."""
        yes, no = (_branch(self._context, node, taken) for taken in (1, 0))
        if yes == self._context:
            return
        if yes in self._sums or no in self._sums:
            fine = self.number(0.0)
            self._add(self.builder.select(condition, self._sums.get(yes, fine), self._sums.get(no, fine)))
        if yes in self._flags or no in self._flags:
            none = self.truth(False)
            self.flag(self.builder.select(condition, self._flags.get(yes, none), self._flags.get(no, none)))


def _branch(trials: TrialSet, select: int, branch: int) -> TrialSet:
    """Return the trials that take a branch; where sets would lie too deep, all of those that are given."""
    return trials if trials.depth == DEEPEST_BRANCHES else trials.taking(select, branch)


def contexts(dag: Dag, rules: Mapping[int, LoopRule], results: Sequence[int]) -> dict[int, TrialSet]:
    """Find the context of every node that `rules` computes, `results` being needed in all trials."""
    result: dict[int, TrialSet] = {node: ALL_TRIALS for node in results if node in rules}
    for node in sorted(rules, reverse=True):
        for used, context in _edges(dag, node, rules[node], result.get(node, ALL_TRIALS)):
            if used in rules:
                result[used] = common_set(result.get(used), context)
    return result


def _edges(dag: Dag, node_id: int, rule: LoopRule, context: TrialSet) -> Iterator[tuple[int, TrialSet]]:
    node = dag.nodes[node_id]
    if isinstance(node, Select):
        yield node.condition, context
        yield node.yes, _branch(context, node_id, 1)
        yield node.no, _branch(context, node_id, 0)
    else:
        for used in reads(dag, node_id, rule):
            yield used, context
