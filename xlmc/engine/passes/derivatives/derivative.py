"""The results of differentiation, and the notes that are taken during it.

Notes say where functions take different ways, where derivatives are lost, and which functions have no rule. Letters: n
trials or points, k assumptions.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from xlmc.excel.address import Cell
from xlmc.excel.functions.values import Bools, Floats

__all__ = ["Derivative", "Derivatives", "Kink", "Notes", "Numerical", "Undefined"]


@dataclass(frozen=True, slots=True, eq=False)
class Derivative:
    """A cell as a function of the assumptions, near each of `n` points.

    A derivative is NaN where there is none: the cell is an error, or the function turns or jumps there. The reason is
    among `Derivatives.undefined`.

    Attributes:
        cell: the one that is differentiated.
        value: `(n,)`, NaN where the cell is no number; TRUE and FALSE are 1 and 0.
        gradient: `(n, k)`, in units of the cell per unit of the assumption.
        gradient_error: `(n, k)`, estimates; 0 where every function on the way has a rule: only rounding is left then.
        hessian: `(n, k, k)`, symmetric; None unless second derivatives were asked for.
        hessian_error: `(n, k, k)`, estimates, as `gradient_error`.
    """

    cell: Cell
    value: Floats
    gradient: Floats
    gradient_error: Floats
    hessian: Floats | None = None
    hessian_error: Floats | None = None


@dataclass(frozen=True, slots=True)
class Kink:
    """A function that takes different ways in different trials: the derivative, or the value, jumps in between.

    Attributes:
        cell: whose formula it is in.
        function: its name in Excel.
        branches: how many there are among the trials; a rounding has one for each result.
        share: of the trials that do not go the way that most go.
        jumps: whether the value itself may jump, as that of an IF, a lookup or a rounding; ABS, MIN and MAX only turn.
    """

    cell: Cell
    function: str
    branches: int
    share: float
    jumps: bool


@dataclass(frozen=True, slots=True)
class Undefined:
    """A place where there is no derivative.

    Attributes:
        cell: whose formula it is in.
        function: its name in Excel.
        why: in words, to follow "no derivative: ".
        trials: how many of them.
        first: the first of them, counted from 0.
    """

    cell: Cell
    function: str
    why: str
    trials: int
    first: int


@dataclass(frozen=True, slots=True)
class Numerical:
    """A function without a rule, differentiated by differences of its values.

    Attributes:
        cell: whose formula it is in.
        function: its name in Excel.
        error: the largest estimate of the error of one of its first derivatives, as a share of that derivative; NaN
            where there is no estimate.
    """

    cell: Cell
    function: str
    error: float


@dataclass(frozen=True, eq=False)
class Derivatives:
    """The derivatives of a workbook's cells with respect to its live assumptions, each varying alone.

    Attributes:
        names: of the `k` assumptions, in the order of the columns of every gradient.
        points: `(n, k)` where they were taken.
        forecasts: name -> the derivative of its cell.
        filters: name -> the derivative of the cell that it tests (not of the test, whose derivative is 0).
        cells: other cells that were asked for -> their derivatives.
        kinks: the functions that take different ways among the points, the most evenly divided first.
        undefined: why derivatives are NaN.
        numerical: the functions without a rule.
    """

    names: tuple[str, ...]
    points: Floats
    forecasts: Mapping[str, Derivative]
    filters: Mapping[str, Derivative]
    cells: Mapping[Cell, Derivative]
    kinks: tuple[Kink, ...]
    undefined: tuple[Undefined, ...]
    numerical: tuple[Numerical, ...]


@dataclass
class Notes:
    """Notes, collected over the portions of a run.

    Attributes:
        branches: node -> way -> in how many trials.
        lost: node -> why -> the trials, counted from 0.
        errors: node -> the largest relative error of a difference.
    """

    branches: dict[int, Counter[float]] = field(default_factory=lambda: defaultdict(Counter))
    lost: dict[int, dict[str, list[NDArray[np.intp]]]] = field(default_factory=lambda: defaultdict(dict))
    errors: dict[int, float] = field(default_factory=dict)
    names: dict[int, str] = field(default_factory=dict)
    jumping: set[int] = field(default_factory=set)

    def took(self, node: int, name: str, branches: NDArray[np.generic], jumps: bool) -> None:
        """Note the ways that a function took, one for each trial."""
        self.names[node] = name
        if jumps:
            self.jumping.add(node)
        values, counts = np.unique(np.asarray(branches, np.float64), return_counts=True)
        self.branches[node].update(dict(zip(values.tolist(), counts.tolist(), strict=True)))

    def lose(self, node: int, name: str, why: str, trials: Bools, start: int) -> None:
        """Note that a function lost the derivatives in these trials of a portion that starts at `start`."""
        self.names[node] = name
        self.lost[node].setdefault(why, []).append(np.flatnonzero(trials) + start)

    def note_difference(self, node: int, name: str, first: Floats, error: Floats | None) -> None:
        """Note that a function was differentiated by differences."""
        self.names[node] = name
        with np.errstate(all="ignore"):
            share = np.abs((0.0 if error is None else error) / first)
        share = share[np.isfinite(share)]
        worst = float(share.max()) if share.size else float("nan")
        known = self.errors.get(node, float("nan"))
        self.errors[node] = worst if np.isnan(known) else max(known, worst) if worst == worst else known

    def kinks(self, owners: Mapping[int, Cell]) -> tuple[Kink, ...]:
        """List the functions that took more than one branch, the most evenly divided first."""
        result = []
        for node, branches in self.branches.items():
            if len(branches) > 1:
                share = 1 - max(branches.values()) / branches.total()
                result.append(Kink(owners[node], self.names[node], len(branches), share, node in self.jumping))
        return tuple(sorted(result, key=lambda kink: -kink.share))

    def undefined(self, owners: Mapping[int, Cell], concerned: Iterable[int]) -> tuple[Undefined, ...]:
        """List the places without a derivative, in trials that concern a cell that was asked for; most trials first."""
        those = np.fromiter(concerned, np.intp)
        results = []
        for node, reasons in self.lost.items():
            for why, parts in reasons.items():
                trials = np.intersect1d(np.concatenate(parts), those)
                if trials.size:
                    results.append(Undefined(owners[node], self.names[node], why, int(trials.size), int(trials[0])))
        return tuple(sorted(results, key=lambda each: -each.trials))

    def numerical(self, owners: Mapping[int, Cell]) -> tuple[Numerical, ...]:
        """List the functions without a rule, the least certain first."""
        results = [Numerical(owners[node], self.names[node], error) for node, error in self.errors.items()]
        return tuple(sorted(results, key=lambda each: -np.nan_to_num(each.error)))
