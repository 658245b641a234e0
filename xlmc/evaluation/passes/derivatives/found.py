"""What differentiation finds. Letters: n trials or points, k assumptions."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from xlmc.address import Cell

__all__ = ["Derivative", "Derivatives", "Kink", "Numerical", "Undefined"]

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Derivative:
    """A cell as a function of the assumptions, near each of `n` points.

    A derivative is NaN where there is none: the cell is an error, or the function turns or jumps there. The reason is
    among `Derivatives.undefined`.

    Attributes:
        cell: whose.
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
        ways: how many there are among the trials; a rounding has one for each result.
        share: of the trials that do not go the way that most go.
        jumps: whether the value itself may jump, as that of an IF, a lookup or a rounding; ABS, MIN and MAX only turn.
    """

    cell: Cell
    function: str
    ways: int
    share: float
    jumps: bool


@dataclass(frozen=True, slots=True)
class Undefined:
    """Where derivatives were lost.

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
            where there is none to speak of.
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
        forecasts: name -> of its cell.
        filters: name -> of the cell that it tests (not of the test, whose derivative is 0).
        cells: the cells asked for besides.
        kinks: what takes different ways among the points; those of the most evenly divided first.
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
