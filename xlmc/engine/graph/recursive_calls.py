"""A LAMBDA that calls itself, evaluated: each call takes the trials that come to it, and no call is written out.

Values are computed when they are asked for: each branch of an `IF` on the trials that take it. So a trial ends its
calls where its own numbers say so. What waits for a value stands on a list, and not on Python's stack, so that calls
may be thousands deep.
"""

from __future__ import annotations

from collections.abc import Generator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from xlmc.engine.graph.node_values import Ragged, corner, evaluate_node
from xlmc.engine.graph.nodes import Apply, IfErrorNode, Range, Select, uses
from xlmc.errors import ErrorCode, FormulaError
from xlmc.excel.functions.budget import MOST_STEPS, ask_for_live
from xlmc.excel.functions.logical import zero_if_blank
from xlmc.excel.functions.lookup.picked_cells import join_values, map_parts
from xlmc.excel.functions.values import BLANK, ERROR, Codes, Value, constant

__all__ = ["Body", "SelfCall", "call_lambda", "join_trials", "spread_trials"]


class SelfCall(NamedTuple):
    """The LAMBDA calls itself with these arguments."""

    arguments: tuple[int, ...]


Step = Apply | Select | IfErrorNode | Range | SelfCall


@dataclass(frozen=True, slots=True)
class Body:
    """The calculation of a LAMBDA that calls itself.

    Slots count its parameters, then what it takes from outside, which all calls share, then constants and steps.

    Attributes:
        parameters, taken: how many there are.
        constants, steps: by slot.
        result: the slot of what a call gives.
        last: the calls of itself whose value is the result unchanged, and the `IF`s that lead to them: such a call is
            computed as the next round of the same call.
        deepest: calls within calls; one more is `#NUM!`.
    """

    parameters: int
    taken: int
    constants: Mapping[int, Value]
    steps: Mapping[int, Step]
    result: int
    last: frozenset[int]
    deepest: int


class _TooDeep(Exception):  # noqa: N818 - it is Excel's error, as a value
    """Calls within calls are too many.

    Attributes:
        trials: in which, counted from 0.
    """

    def __init__(self, trials: Trials) -> None:
        super().__init__()
        self.trials = trials


Trials = NDArray[np.intp]


@dataclass(eq=False, slots=True)
class _Frame:
    """A call, or a branch within one, and the values known.

    Attributes:
        trials: in which it is made, counted as in the outermost call.
        own_trials: the same trials, counted as in this call.
        index: the same, counted as in the frame around it.
        bytes: the memory of the values that were worked out here.
    """

    values: dict[int, Value]
    trials: Trials
    own_trials: Trials
    depth: int
    parent: _Frame | None = None
    index: Trials | None = None
    bytes: int = 0

    def find(self, slot: int) -> Value | None:
        """Return a value that was computed here, or for more trials further out."""
        value = self.values.get(slot)
        if value is None and self.parent is not None and self.index is not None:
            value = self.parent.find(slot)
            if value is not None:
                self.values[slot] = value = value.take(self.index)
        return value

    def of(self, index: Trials) -> _Frame:
        """Restrict the call to some of the trials, those of one branch."""
        if index.size == self.trials.size:
            return self
        return _Frame({}, self.trials[index], self.own_trials[index], self.depth, self, index)


@dataclass(slots=True)
class _Round:
    """The outcome of one round of a call: results, and the arguments of the next round, each with their trials."""

    results: list[tuple[Trials, Value]]
    next_calls: list[tuple[_Frame, list[Value]]]


Asking = Generator[tuple[_Frame, int], Value, Any]
"""Asks for values, by frame and slot, and gives one."""


def call_lambda(body: Body, *values: Value) -> Value:
    """Return what a call gives, (n,), of its arguments and of what it takes from outside.

    Raises:
        FormulaError: it gives an array, or its calls take too many steps; calls too deep are `#NUM!`.
    """
    n = max((value.shape[0] for value in values), default=1)
    left, parts, work = np.arange(n), list[tuple[Trials, Value]](), _Work()
    while left.size:
        try:
            given = values if left.size == n else [value.take(left) for value in values]
            parts.append((left, _single(_Run(body, work).value(given, np.arange(left.size)))))
            break
        except _TooDeep as stopped:
            parts.append((left[stopped.trials], constant(ErrorCode.NUM)))
            left = np.delete(left, stopped.trials)
            if len(parts) > _MOST_RESTARTS:
                raise _too_often() from None
    return join_trials(n, parts)


_MOST_RESTARTS: Final = 50
"""How often the trials that call too deep are taken out, and the others evaluated again."""


def _single(value: Value) -> Value:
    if isinstance(value, Ragged) or (value.numbers.ndim == 3 and value.shape[1:] != (1, 1)):
        raise FormulaError("a LAMBDA that calls itself gives an array", hint="give single values, or use REDUCE")
    return corner(value)


def _too_often() -> FormulaError:
    message = f"the calls of a LAMBDA by itself take more than {MOST_STEPS:,} steps"
    return FormulaError(message, hint="let its calls end sooner, let it call itself once and not twice, or use REDUCE")


@dataclass(slots=True)
class _Work:
    """Counts what is computed in all calls, also in those that are made again."""

    steps: int = 0

    def add(self) -> None:
        """Count a step.

        Raises:
            FormulaError: there are too many.
        """
        self.steps += 1
        if self.steps > MOST_STEPS:
            raise _too_often()


@dataclass(slots=True)
class _Run:
    body: Body
    work: _Work
    live: int = 0
    _waiting: list[Asking] = field(default_factory=list)

    def value(self, values: Sequence[Value], trials: Trials) -> Value:
        """Return the result of the outermost call."""
        self._waiting = [self._call(dict(enumerate(values)), trials, 1)]
        answer: Any = None
        while self._waiting:
            try:
                asked, slot = self._waiting[-1].send(answer)
            except StopIteration as done:
                self._waiting.pop()
                answer = done.value
                continue
            answer = self._find(asked, slot)
            if answer is None:
                self._waiting.append(self._work_out(asked, slot))
        result: Value = answer
        return result

    def _call(self, values: dict[int, Value], trials: Trials, depth: int) -> Asking:
        """Run a call and the rounds that follow it."""
        body = self.body
        taken = {slot: values[slot] for slot in range(body.parameters, body.parameters + body.taken)}
        frame = _Frame(values, trials, np.arange(trials.size), depth)
        results: list[tuple[Trials, Value]] = []
        while True:
            result = _Round(results, [])
            yield from self._round(frame, body.result, result, False)
            self.live -= frame.bytes
            if not result.next_calls:
                return join_trials(trials.size, results)
            frame = self._next(frame, result.next_calls, taken)

    def _round(self, frame: _Frame, slot: int, result: _Round, chosen: bool) -> Asking:
        """Follow the `IF`s to a result or to the next round. `chosen`: by an `IF`, which makes a blank 0."""
        step = self.body.steps.get(slot) if slot in self.body.last else None
        if isinstance(step, SelfCall):
            result.next_calls.append((frame, (yield from _ask(frame, step.arguments))))
        elif isinstance(step, Select):
            condition = yield frame, step.condition
            truth, errors = _decide(condition)
            wrong = _find_marked(errors > 0, frame)
            if wrong.size:
                result.results.append(
                    (frame.own_trials[wrong], Value.of_errors(np.broadcast_to(errors, frame.trials.shape)[wrong]))
                )
            for branch, taken in ((step.yes, truth & (errors == 0)), (step.no, ~truth & (errors == 0))):
                index = _find_marked(taken, frame)
                if index.size:
                    inner = frame.of(index)
                    yield from self._round(inner, branch, result, True)
                    self.live -= 0 if inner is frame else inner.bytes
        else:
            value = yield frame, slot
            result.results.append((frame.own_trials, zero_if_blank(value) if chosen else value))

    def _next(self, frame: _Frame, next_calls: list[tuple[_Frame, list[Value]]], taken: dict[int, Value]) -> _Frame:
        """Start the next round of a call."""
        frames = [each for each, _ in next_calls]
        arguments = next_calls[0][1]
        if len(next_calls) > 1:
            columns = zip(*(values for _, values in next_calls), strict=True)
            arguments = [_one_after_another(frames, column) for column in columns]
        own_trials = np.concatenate([each.own_trials for each in frames])
        self._count(np.concatenate([each.trials for each in frames]), frame.depth)
        values = dict(enumerate(arguments)) | {slot: value.take(own_trials) for slot, value in taken.items()}
        trials = np.concatenate([each.trials for each in frames])
        return _Frame(values, trials, own_trials, frame.depth + 1)

    def _count(self, trials: Trials, depth: int) -> None:
        """Count one more call within a call of that depth."""
        if depth >= self.body.deepest:
            raise _TooDeep(trials)
        self.work.add()

    def _find(self, frame: _Frame, slot: int) -> Value | None:
        return self.body.constants.get(slot) or frame.find(slot)

    def _work_out(self, frame: _Frame, slot: int) -> Asking:
        step = self.body.steps[slot]
        self.work.add()
        if isinstance(step, Select):
            value = yield from self._select(frame, step)
        elif isinstance(step, IfErrorNode):
            value = yield from self._if_error(frame, step)
        elif isinstance(step, SelfCall):
            value = yield from self._call_itself(frame, step)
        else:
            values = {}
            for used in uses(step):
                values[used] = yield frame, used
            value = evaluate_node(step, values)
        frame.values[slot] = value
        frame.bytes += value.nbytes
        self.live += value.nbytes
        ask_for_live(self.live)
        return value

    def _call_itself(self, frame: _Frame, step: SelfCall) -> Asking:
        arguments = yield from _ask(frame, step.arguments)
        values = dict(enumerate(arguments))
        self._count(frame.trials, frame.depth)
        for slot in range(self.body.parameters, self.body.parameters + self.body.taken):
            values[slot] = _find_taken(frame, slot)
        return (yield from self._call(values, frame.trials, frame.depth + 1))

    def _select(self, frame: _Frame, step: Select) -> Asking:
        condition = yield frame, step.condition
        truth, errors = _decide(condition)
        value = yield from self._each(frame, [(step.yes, truth & (errors == 0)), (step.no, ~truth & (errors == 0))])
        return evaluate_node(Select(0, 1, 1), {0: condition, 1: value})

    def _if_error(self, frame: _Frame, step: IfErrorNode) -> Asking:
        value = yield frame, step.value
        lost = value.kinds == ERROR + ErrorCode.NA if step.only_na else value.kinds >= ERROR
        if lost.ndim == 3:
            lost = np.ones(1, bool)
        instead = yield from self._each(frame, [(step.instead, lost)])
        return evaluate_node(IfErrorNode(0, 1, step.only_na), {0: value, 1: instead})

    def _each(self, frame: _Frame, branches: list[tuple[int, NDArray[np.bool_]]]) -> Asking:
        """Every branch on the trials that take it, put together; blank in trials that take none."""
        parts = []
        for slot, taken in branches:
            index = _find_marked(taken, frame)
            if index.size:
                inner = frame.of(index)
                parts.append((index, (yield inner, slot)))
                self.live -= 0 if inner is frame else inner.bytes
        return join_trials(frame.trials.size, parts)


def _ask(frame: _Frame, slots: Sequence[int]) -> Asking:
    """Return the values of several slots."""
    values = []
    for slot in slots:
        value = yield frame, slot
        values.append(value)
    return values


def _decide(condition: Value) -> tuple[NDArray[np.bool_], Codes]:
    """Return the trials in which a condition is true, and its errors."""
    if condition.numbers.ndim == 3:
        raise FormulaError("an array decides whether a LAMBDA calls itself", hint="use a single condition")
    truth, errors = condition.to_logicals()
    return np.broadcast_arrays(truth, errors)  # type: ignore[return-value]


def _find_marked(taken: NDArray[np.bool_], frame: _Frame) -> Trials:
    """Return the trials that are marked, counted in a frame."""
    return np.flatnonzero(np.broadcast_to(taken, frame.trials.shape))


def _one_after_another(frames: Sequence[_Frame], values: Sequence[Value]) -> Value:
    """Join the values of several frames into one."""
    return join_values(
        [spread_trials(value, frame.trials.size) for frame, value in zip(frames, values, strict=True)], axis=0
    )


def spread_trials(value: Value, n: int) -> Value:
    """Make of a value that is the same in all trials one of each."""
    return map_parts(value, lambda part: np.broadcast_to(part, (n, *part.shape[1:])))


def _find_taken(frame: _Frame, slot: int) -> Value:
    value = frame.find(slot)
    assert value is not None, "what is taken from outside was given to the first call"
    return value


def join_trials(n: int, parts: list[tuple[Trials, Value]]) -> Value:
    """Join values of some trials each into one of all trials."""
    if len(parts) == 1 and np.array_equal(parts[0][0], np.arange(n)):
        return parts[0][1]
    sizes = {value.shape[1:] for _, value in parts}
    if len(sizes) > 1 or any(isinstance(value, Ragged) for _, value in parts):
        raise FormulaError("a LAMBDA that calls itself gives arrays of several sizes", hint="give single values")
    size = (n, *next(iter(sizes), ()))
    has_texts = any(value.texts is not None for _, value in parts)
    out = Value(np.zeros(size), np.full(size, BLANK, np.uint8), np.full(size, "", object) if has_texts else None)
    for index, value in parts:
        spread = spread_trials(value, index.size)
        out.numbers[index], out.kinds[index] = spread.numbers, spread.kinds
        if out.texts is not None and spread.texts is not None:
            out.texts[index] = spread.texts
    return out
