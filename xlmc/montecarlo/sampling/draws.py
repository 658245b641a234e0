"""From uniforms to draws: every assumption by its own quantile function."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from numbers import Real
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.engine.engine import Linear
from xlmc.errors import SimulationError
from xlmc.excel.address import Cell
from xlmc.excel.functions.denormals import TINIEST, flush
from xlmc.montecarlo.distributions import Family, Truncated
from xlmc.montecarlo.distributions.base import Member
from xlmc.montecarlo.distributions.parameters import Fault
from xlmc.montecarlo.distributions.truncated import Slice
from xlmc.montecarlo.distributions.uniform import Uniform
from xlmc.montecarlo.interruption import checkpoint
from xlmc.montecarlo.sampling.copula import Ties, ties_of
from xlmc.montecarlo.sampling.copulas import Joining
from xlmc.montecarlo.sampling.sampling_plan import SamplingPlan
from xlmc.montecarlo.sampling.streams import Stream

__all__ = ["CorrelatedGroup", "Draw", "DrawStage", "DynamicParameters", "Filler", "Sampler"]

Floats = NDArray[np.float64]

_SMALL: Final = 2.0**-900
"""Numbers below it may have a share, of 2^-53 at least, that is too small for a cell."""

DynamicParameters = Callable[[Mapping[str, Floats], int], Mapping[Cell, Floats]]
"""Takes the draws made so far and the number of trials, gives the parameters that depend on them; NaN for an error."""

Filler = Callable[[Sequence[Stream], Sequence[tuple[float, float]], Floats], Callable[[int], None]]
"""Takes streams of independent trials, an offset and a factor for each, and rows `(k, block)`. What it gives takes the
first trial of a block, and fills each row with offset + factor·uniform."""


@dataclass(frozen=True)
class Draw:
    """How one assumption is drawn.

    Attributes:
        parameters: numbers, or cells whose numbers `DynamicParameters` gives, in the family's order.
        cutoffs: lower and upper, likewise; None without truncation.
        stream: the name that its uniforms are drawn by, where that is another.

    Those that vary are checked in every trial. Where all are numbers, `fault` checks them, and nothing else does.
    """

    name: str
    family: Family
    parameters: tuple[float | Cell, ...]
    cutoffs: tuple[float | Cell, float | Cell] | None = None
    stream: str = ""

    @classmethod
    def of(cls, name: str, family: Family, given: Mapping[str, float | Cell], stream: str = "") -> Draw:
        """Make a draw from parameters by key, with `lower_cutoff` and `upper_cutoff` if the draw is cut off."""
        parameters = dict(given)
        for key, each in given.items():
            if isinstance(each, Real):
                parameters[key] = float(each)
        cutoffs = parameters.pop("lower_cutoff", -np.inf), parameters.pop("upper_cutoff", np.inf)
        return cls(name, family, family.bind((), parameters), cutoffs if len(parameters) < len(given) else None, stream)

    def fault(self) -> Fault | None:
        """Say what keeps its numbers from being a distribution; None if some vary, for each trial has its own then."""
        if not self.fixed:
            return None
        if self.cutoffs is None:
            return Member(self.family, self.parameters).fault()
        return Truncated(self.family).fault(*self.cutoffs, *self.parameters)  # type: ignore[arg-type]  # likewise

    def fill(self, u: Floats, dynamic: Mapping[Cell, Floats]) -> None:
        """Turn uniforms `(n,)` into draws, in their memory; NaN where the parameters of a trial are not a distribution.

        A draw that is too small a number for a cell is 0.
        """
        (self.distribution if self.fixed else self._of_trials(dynamic)).ppf(u, out=u)
        _flush(u)

    @cached_property
    def distribution(self) -> Member | Slice:
        """What the numbers make of the family, where `fixed`."""
        whole = Member(self.family, self.parameters)
        return whole if self.cutoffs is None else Slice(whole, *self.cutoffs)  # type: ignore[arg-type]  # numbers

    def _of_trials(self, dynamic: Mapping[Cell, Floats]) -> Member | Slice:
        """Return the numbers that the parameters of each trial make of it."""
        values = [p if isinstance(p, float) else dynamic[p] for p in (*(self.cutoffs or ()), *self.parameters)]
        return self.family.checked(*values) if self.cutoffs is None else Truncated(self.family).checked(*values)

    def reached(self, x: Floats) -> Floats:
        """Return the uniforms, `(n,)`, of draws that are at most x, `(n,)`: the inverse of `fill`, where `fixed`."""
        return self.distribution.cdf(x)

    @property
    def varying(self) -> list[Cell]:
        """The parameters and cutoffs that vary by trial."""
        return [p for p in (*self.parameters, *(self.cutoffs or ())) if not isinstance(p, float)]

    @cached_property
    def fixed(self) -> bool:
        """Whether no parameter and no cutoff varies by trial."""
        return not self.varying

    @cached_property
    def has_mean(self) -> bool:
        """Whether its mean is a finite number; where parameters vary, each trial has a mean of its own."""
        if not self.fixed or (self.cutoffs is not None and np.isfinite(self.cutoffs).all()):
            return True
        return bool(np.isfinite(Member(self.family, self.parameters).mean()))

    def refuse_no_numbers(self, draws: Floats) -> None:
        """Check what was filled in, `(n,)`; where parameters vary, NaN is an error trial, and counted as one.

        Raises:
            SimulationError: parameters that are numbers gave a draw that is none.
        """
        if self.family.always_finite or not self.fixed:
            return
        with np.errstate(over="ignore", invalid="ignore"):
            likely = np.isfinite(draws.sum())  # quick; a sum of large numbers may overflow, though
        if not likely and not np.isfinite(draws).all():
            message = f"{self.family.name} of the assumption {self.name!r} gives draws that are not numbers"
            raise SimulationError(message, hint="its parameters are too extreme: correct them in the workbook")

    def ties(self) -> Ties | None:
        """Return the values that it takes; None if hardly any two draws are equal, or all, or where parameters vary."""
        return ties_of(self._quantiles) if self.fixed else None

    def _quantiles(self, u: Floats) -> Floats:
        return _flush(self.distribution.order(u))

    def percentiles(self, p: Floats, dynamic: Mapping[Cell, Floats]) -> Floats:
        """Return the values that are not exceeded with these probabilities, `(q,)`, where the parameters are these."""
        return _flush((self.distribution if self.fixed else self._of_trials(dynamic)).percentile(p))

    @cached_property
    def ends(self) -> tuple[float, float] | None:
        """The least and the largest draw; None where either is infinite, or where the parameters vary."""
        if not self.fixed:
            return None
        ends = np.array([0.0, 1.0])
        with np.errstate(all="ignore"):
            self.fill(ends, {})
        return (float(ends[0]), float(ends[1])) if np.isfinite(ends).all() else None

    def offset_and_factor(self) -> tuple[float, float] | None:
        """Two numbers with which offset + factor·u is the draw, to the bit; None if it is not so simple."""
        if not isinstance(self.family, Uniform) or self.cutoffs is not None:
            return None
        low, high = self.parameters
        if not isinstance(low, float) or not isinstance(high, float) or 0 < max(abs(low), abs(high)) < _SMALL:
            return None
        return self.family.offset_and_factor(low, high)


def _flush(draws: Floats) -> Floats:
    """Replace numbers that are too small for a cell by 0, in place."""
    if not draws.min(initial=np.inf) >= TINIEST:
        flush(draws)
    return draws


@dataclass(frozen=True, slots=True)
class DrawStage:
    """Assumptions whose parameters depend on earlier stages only; the first stage's on nothing."""

    draws: tuple[Draw, ...]
    dynamic: bool = False


@dataclass(frozen=True, slots=True)
class CorrelatedGroup:
    """Assumptions that are joined: by rank correlations, or by a copula that stands somewhere."""

    names: tuple[str, ...]
    copula: Joining
    where: Cell | None = None


class Sampler:
    """Draws blocks of trials. For one thread; its memory is used again with every block, and not pickled with it.

    Args:
        seed: of the run.
        stages: in order.
        groups: of correlated assumptions.
        parameters: for each dynamic stage, in order.
        block: trials per block.
        plan: the method and its replicates; by default independent trials.
        filler: draws the uniforms instead of the streams, the same bits; None for the streams themselves.

    Attributes:
        streams: those of the assumptions, row by row, where trials are independent.
    """

    def __init__(
        self,
        seed: int,
        stages: Sequence[DrawStage],
        groups: Sequence[CorrelatedGroup],
        parameters: Sequence[DynamicParameters],
        block: int,
        plan: SamplingPlan | None = None,
        filler: Filler | None = None,
    ) -> None:
        self._made_of = seed, stages, groups, parameters, block, plan, filler
        names = [name for group in groups for name in group.names]
        names += [draw.name for stage in stages for draw in stage.draws if draw.name not in names]
        self._rows = np.empty((len(names), block))
        self._row_of = {name: row for row, name in enumerate(names)}
        streams = {draw.name: draw.stream for stage in stages for draw in stage.draws if draw.stream}
        self._margins = (plan or SamplingPlan.of("mc", block)).margins(seed, names, streams)
        self._stages, self._groups, self._parameters = stages, groups, parameters
        self._block = block
        grouped = {name for group in groups for name in group.names}
        maps = dict.fromkeys(names, (0.0, 1.0))
        self._filled: set[str] = set()
        for stage in stages:
            for draw in stage.draws:
                if draw.name not in grouped and (pair := draw.offset_and_factor()) is not None:
                    maps[draw.name] = pair
                    self._filled.add(draw.name)
        self._maps, self._filler = list(maps.values()), filler
        self.streams = [margin for margin in self._margins if isinstance(margin, Stream)]

    def __reduce__(self) -> tuple[Any, ...]:
        return Sampler, self._made_of

    @cached_property
    def _filling(self) -> Callable[[int], None] | None:
        """What draws the uniforms instead of the streams; made when it is needed, since an engine may draw itself."""
        if self._filler is None or len(self.streams) < len(self._margins):
            return None
        return self._filler(self.streams, self._maps, self._rows)

    def _fill(self, start: int) -> None:
        """Fill each row with offset + factor·uniform, from the trial `start` on."""
        if self._filling is not None:
            self._filling(start)
            return
        for margin, row, (offset, factor) in zip(self._margins, self._rows, self._maps, strict=True):
            checkpoint()
            margin.uniforms(start, row)
            if (offset, factor) != (0.0, 1.0):
                np.multiply(row, factor, out=row)
                np.add(row, offset, out=row)

    @property
    def row_of(self) -> Mapping[str, int]:
        """Name of an assumption -> its row among the uniforms that a filler fills in."""
        return self._row_of

    @property
    def names(self) -> tuple[str, ...]:
        """The assumptions, in the order of their stages."""
        return tuple(draw.name for stage in self._stages for draw in stage.draws)

    @property
    def linear(self) -> Linear | None:
        """All draws as offset + factor·uniform of independent trials; None if any is more."""
        draws = [draw for stage in self._stages for draw in stage.draws]
        maps = [draw.offset_and_factor() for draw in draws]
        if self._groups or None in maps or len(self.streams) < len(draws):
            return None
        streams = tuple(self.streams[self._row_of[draw.name]] for draw in draws)
        return Linear(streams, tuple(pair for pair in maps if pair is not None))

    def draw(self, start: int) -> dict[str, Floats]:
        """Draw the trials `start` to `start + block - 1`, `(block,)` each; NaN for an error."""
        self._fill(start)
        for group in self._groups:
            first = self._row_of[group.names[0]]
            group.copula.join(self._rows[first : first + len(group.names)])
        drawn: dict[str, Floats] = {}
        dynamic = iter(self._parameters)
        for stage in self._stages:
            known = next(dynamic)(drawn, self._block) if stage.dynamic else {}
            for draw in stage.draws:
                drawn[draw.name] = self._rows[self._row_of[draw.name]]
                if draw.name not in self._filled:
                    checkpoint()
                    draw.fill(drawn[draw.name], known)
                    draw.refuse_no_numbers(drawn[draw.name])
        return drawn
