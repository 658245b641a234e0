"""Evidence: a measured number, its error, and the cell that says what the model has in its place.

The error of a reading is a law: a chance density of the reading, given what the model's quantity is. Letters: m the
model's quantity, R the reading, z the distance of the two in standard deviations.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Final

import numpy as np
from numpy.typing import NDArray

from xlmc.excel.address import Cell, InFormula
from xlmc.excel.formula import ir
from xlmc.montecarlo.definitions.forms import PLAIN, Form

__all__ = ["ERRORS", "SIZES", "USE_IS_OFF", "Bell", "Evidence", "Law", "Within"]

Floats = NDArray[np.float64]

ERRORS: Final = {
    "uniform": "Uniform",
    "instrument": "Instrument",
    "normal": "Normal",
    "lognormal": "Lognormal",
    "at least": "At least",
    "at most": "At most",
}
"""Kinds of error, and how they are written."""

SIZES: Final = {
    "plus_minus": "Plus or minus",
    "std_dev": "Std dev",
    "percent": "Percent",
    "resolution": "Resolution",
}
"""What says how large an error is, and the headings."""

_FARTHEST: Final = 39.0
"""Standard deviations beyond which exp(-z²/2) is 0 in double precision."""


USE_IS_OFF: Final = "Use is off"
"""Why a row does not count that could."""


@dataclass(frozen=True, slots=True)
class Within:
    """A reading that is equally likely anywhere within a tolerance of what is measured: |R - m| ≤ share·|m| + width.

    Attributes:
        reading: R.
        share, width: of the tolerance; it may grow with m.
        sides: whether m may be too low, too high: one-sided evidence bounds one side alone.
    """

    reading: float
    share: float
    width: float
    sides: tuple[bool, bool] = (True, True)

    @property
    def low(self) -> float | None:
        """The least m that is kept; otherwise None."""
        if not self.sides[0]:
            return None
        rest = self.reading - self.width
        return rest / (1.0 + self.share) if rest >= 0.0 else rest / (1.0 - self.share)

    @property
    def high(self) -> float | None:
        """The largest m that is kept; otherwise None."""
        if not self.sides[1]:
            return None
        rest = self.reading + self.width
        return rest / (1.0 - self.share) if rest >= 0.0 else rest / (1.0 + self.share)

    @property
    def one_sided(self) -> bool:
        """Whether it bounds m on one side alone."""
        return not all(self.sides)

    def beyond(self, m: Floats) -> Floats:
        """`(n,)` by how many tolerances m lies beyond the limits: 0 within, infinite for a tolerance of 0."""
        low = -np.inf if self.low is None else self.low
        high = np.inf if self.high is None else self.high
        outside = np.maximum(np.maximum(low - m, m - high), 0.0)
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            values = outside / (self.share * np.abs(m) + self.width)
        return np.where(outside > 0.0, values, 0.0)

    def log_weight(self, m: Floats) -> Floats:
        """`(n,)` 0 where m is kept, -inf where it is not."""
        return np.where(self.beyond(m) > 0.0, -np.inf, 0.0)

    def reached(self, m: Floats) -> Floats:
        """`(n,)` the chance that another reading of m would have been at most R."""
        tolerance = self.share * np.abs(m) + self.width
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            values = (self.reading - m + tolerance) / (2.0 * tolerance)
        return np.where(tolerance > 0.0, np.clip(values, 0.0, 1.0), m <= self.reading)


@dataclass(frozen=True, slots=True)
class Bell:
    """A reading with a normal error: z = (R - m)/σ; or with a lognormal one: z = ln(R/m)/σ.

    One-sided evidence is a reading that was cut off (censored): what would have been read, m + σε, lies on one side of
    R, and nothing more is known. It keeps a trial with the chance of that, Φ(-z) or Φ(z).

    Attributes:
        reading: R.
        sigma: σ, in the units of the reading, or of the logarithm.
        logarithmic: whether the error is lognormal.
        sides: whether m may be too low, too high, as in `Within`.
    """

    reading: float
    sigma: float
    logarithmic: bool = False
    sides: tuple[bool, bool] = (True, True)

    @property
    def one_sided(self) -> bool:
        """Whether it bounds m on one side alone."""
        return not all(self.sides)

    def z(self, m: Floats) -> Floats:
        """`(n,)`; infinite where m has no logarithm; 0 where one-sided evidence is beyond doubt on its side."""
        if self.logarithmic:
            with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
                return np.where(m > 0.0, np.log(self.reading / m) / self.sigma, np.inf)
        low, high = (None if side else 0.0 for side in self.sides)
        with np.errstate(over="ignore"):
            z = (self.reading - m) / self.sigma
        return np.clip(z, high, low) if self.one_sided else z

    def log_weight(self, m: Floats) -> Floats:
        """`(n,)` the logarithm of the chance that a trial is kept: -z²/2, or that of a normal tail."""
        if self.one_sided:
            from scipy.special import log_ndtr

            with np.errstate(over="ignore"):
                z = (self.reading - m) / self.sigma
            logs = log_ndtr(-z if self.sides[0] else z)
            return np.where(logs >= -0.5 * _FARTHEST**2, logs, -np.inf)
        z = self.z(m)
        with np.errstate(over="ignore"):
            return np.where(np.abs(z) <= _FARTHEST, -0.5 * z * z, -np.inf)

    def reached(self, m: Floats) -> Floats:
        """`(n,)` the chance that another reading of m would have been at most R."""
        from scipy.special import ndtr

        return np.asarray(ndtr(self.z(m)))

    def tree_of_chance(self, cell: Cell) -> ir.Expression:
        """Write the chance that a trial is kept as a formula of the model's cell."""
        m, reading = ir.Binary("+", cell, ir.Number(0.0)), ir.Number(self.reading)
        if self.one_sided:
            inside = ir.Binary("-", m, reading) if self.sides[0] else ir.Binary("-", reading, m)
            z = ir.Binary("/", inside, ir.Number(self.sigma))
            return ir.Call("NORM.S.DIST", (z, ir.Logical(value=True)))
        apart: ir.Expression = ir.Binary("-", reading, m)
        if self.logarithmic:
            apart = ir.Call("LN", (ir.Binary("/", reading, m),))
        z = ir.Binary("/", apart, ir.Number(self.sigma))
        return ir.Call("EXP", (ir.Binary("*", ir.Number(-0.5), ir.Binary("*", z, z)),))


Law = Within | Bell


@dataclass(frozen=True, slots=True)
class Evidence:
    """A row of `xlmc_evidence`.

    Attributes:
        cell: what the model has in place of the reading.
        reading: the measured number; None if none was entered.
        error: a key of `ERRORS`.
        sizes: key of `SIZES` -> number or cell, of those that are filled in.
        unused: why it does not count, in words, such as `USE_IS_OFF`; empty where it does.
        weighed: a run weights its trials by it, where its error is no limit, instead of rejecting some.
        notes: the table's other columns.
        form: how numbers in its cell, and the reading, are written.
    """

    name: str
    cell: Cell
    row: Cell
    reading: float | Cell | None
    error: str
    sizes: Mapping[str, float | Cell] = field(default_factory=dict)
    source: str = ""
    unused: str = ""
    notes: Mapping[str, str] = field(default_factory=dict)
    weighed: bool = False
    form: Form = field(default=PLAIN, compare=False, repr=False)

    @property
    def used(self) -> bool:
        """Whether it counts; one that does not is only listed."""
        return not self.unused

    @property
    def can_be_used(self) -> bool:
        """Whether it counts where nothing switches it off: it has a reading."""
        return self.unused in ("", USE_IS_OFF)

    @property
    def cells(self) -> Iterator[Cell]:
        """The cells whose formulas compute its numbers."""
        for value in (self.reading, *self.sizes.values()):
            if isinstance(value, Cell):
                yield value

    @property
    def law(self) -> Law:
        """The reading and its error as a law of probability; all its numbers must be known."""
        reading, sizes = self.reading, self.sizes
        assert isinstance(reading, float)
        assert not any(isinstance(each, Cell) for each in sizes.values())
        given = {key: float(value) for key, value in sizes.items()}  # type: ignore[arg-type]  # numbers, as asserted
        share, width = given.get("percent", 0.0) / 100.0, given.get("plus_minus", given.get("resolution", 0.0))
        match self.error:
            case "normal":
                return Bell(reading, given.get("std_dev", share * abs(reading)))
            case "lognormal":
                return Bell(reading, given.get("std_dev", share), logarithmic=True)
            case "uniform":
                return Within(reading, 0.0, given.get("plus_minus", share * abs(reading)))
            case "at least" | "at most":
                sides = (self.error == "at least", self.error == "at most")
                if given.get("std_dev"):
                    return Bell(reading, given["std_dev"], sides=sides)
                return Within(reading, share, width, sides)
        return Within(reading, share, width)

    @property
    def is_censored(self) -> bool:
        """Whether it is one-sided with a normal error: a reading that was cut off."""
        return self.error in ("at least", "at most") and "std_dev" in self.sizes

    @property
    def bell(self) -> Bell | None:
        """The law of the reading's error; None if the evidence is a limit."""
        law = self.law if self.error in ("normal", "lognormal") or self.is_censored else None
        return law if isinstance(law, Bell) else None

    @property
    def by_chance(self) -> bool:
        """Whether a uniform number decides if it keeps a trial."""
        return self.bell is not None and not self.weighed

    @property
    def chance(self) -> InFormula:
        """Stands for the uniform number that decides whether a trial is kept, where its law is no limit."""
        return InFormula.of(self.cell, f"evidence {self.name}")

    @property
    def stream(self) -> str:
        """The name of that number's random stream, which no assumption can have."""
        return f"evidence\x1f{self.name.strip().casefold()}"
