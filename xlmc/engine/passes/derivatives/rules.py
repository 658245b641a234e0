"""Rules say what a function of the registry does to derivatives. Each is a row, each family of them a file.

A rule gets the function, its result and its operands; the value is never computed again, so that it is the run's own.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from xlmc.engine.passes.derivatives.jet import Jet, chain
from xlmc.excel.functions import Function
from xlmc.excel.functions.values import Floats, Value

__all__ = ["RULES", "DerivativeRule", "Operand", "Outcome", "elementwise", "level_jets", "rule"]

Branches = NDArray[Any]


class Operand(NamedTuple):
    """An argument: the value with its kinds, and the jet of it as a number."""

    value: Value
    jet: Jet


class Outcome(NamedTuple):
    """What a rule finds.

    Attributes:
        jet: the result with its derivatives; those that are not finite count as none.
        branches: `(n,)` which way the function took in each trial, as any number; None if it has only one.
        numerical: whether differences were taken.
    """

    jet: Jet
    branches: Branches | None = None
    numerical: bool = False


Apply = Callable[[Function, Value, Sequence[Operand]], Outcome]


@dataclass(frozen=True, slots=True)
class DerivativeRule:
    """How derivatives pass a function.

    Attributes:
        apply: the rule itself.
        why: where there is no derivative though the value is a number, in words.
        jumps: whether the value jumps where the way changes; if not, it turns.
    """

    apply: Apply
    why: str
    jumps: bool = False


RULES: Final[dict[str, DerivativeRule]] = {}


def rule(*names: str, why: str = "", jumps: bool = False) -> Callable[[Apply], Apply]:
    """Register the rule of functions, under the names of their rows in the registry."""

    def register(apply: Apply) -> Apply:
        for name in names:
            if name in RULES:
                raise ValueError(f"{name} has two rules")
            RULES[name] = DerivativeRule(apply, why, jumps)
        return apply

    return register


def level_jets(operands: Sequence[Operand]) -> list[Jet]:
    """Return the jets, all as ranges where one of them is one."""
    jets = [operand.jet for operand in operands]
    return [jet.as_range() for jet in jets] if any(jet.x.ndim == 3 for jet in jets) else jets


def elementwise(
    name: str,
    firsts: Callable[..., Sequence[Any]],
    seconds: Callable[..., Sequence[Any]],
    *,
    why: str = "",
    branches: Callable[..., Branches] | None = None,
    jumps: bool = False,
) -> None:
    """Register a function of single numbers by its partial derivatives.

    Args:
        name: of its row.
        firsts: of (value, arguments): one derivative an argument.
        seconds: of the same: second derivatives in the order 11, 12, …, 22, 23, …
        why: see `DerivativeRule`.
        branches: of (value, arguments): which way it takes.
        jumps: see `DerivativeRule`.
    """

    def apply(function: Function, result: Value, operands: Sequence[Operand]) -> Outcome:
        jets = level_jets(operands)
        y: Floats = result.numbers
        x = [jet.x for jet in jets]
        pairs = [(i, j) for i in range(len(jets)) for j in range(i, len(jets))]
        jet = chain(y, jets, list(firsts(y, *x)), lambda: dict(zip(pairs, seconds(y, *x), strict=True)))
        return Outcome(jet, None if branches is None else np.asarray(branches(y, *x)))

    rule(name, why=why, jumps=jumps)(apply)
