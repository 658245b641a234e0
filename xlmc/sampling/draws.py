"""From uniforms to draws: every assumption by its own quantile function."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from xlmc.distributions import Family, Truncated
from xlmc.sampling.copula import GaussianCopula
from xlmc.sampling.plan import Plan

__all__ = ["CorrelatedGroup", "Draw", "DynamicParameters", "Sampler", "Stage"]

Floats = NDArray[np.float64]

DynamicParameters = Callable[[Mapping[str, Floats], int], Mapping[Hashable, Floats]]
"""Takes the draws made so far and the number of trials, gives the parameters that depend on them; NaN for an error."""


@dataclass(frozen=True, slots=True)
class Draw:
    """How one assumption is drawn.

    Attributes:
        parameters: numbers, or keys into what `DynamicParameters` gives, in the family's order.
        cutoffs: lower and upper, likewise; None without truncation.
    """

    name: str
    family: Family
    parameters: tuple[Hashable, ...]
    cutoffs: tuple[Hashable, Hashable] | None = None

    def fill(self, u: Floats, dynamic: Mapping[Hashable, Floats]) -> None:
        """Turn uniforms `(n,)` into draws, in place; NaN where the parameters of a trial are no distribution."""
        parameters = [_known(p, dynamic) for p in self.parameters]
        if self.cutoffs is None:
            self.family.ppf(u, *parameters, out=u)
        else:
            lower, upper = (_known(c, dynamic) for c in self.cutoffs)
            Truncated(self.family).ppf(u, lower, upper, *parameters, out=u)


def _known(parameter: Hashable, dynamic: Mapping[Hashable, Floats]) -> float | Floats:
    return parameter if isinstance(parameter, float) else dynamic[parameter]


@dataclass(frozen=True, slots=True)
class Stage:
    """Assumptions whose parameters depend on earlier stages only; the first stage's on nothing."""

    draws: tuple[Draw, ...]
    dynamic: bool = False


@dataclass(frozen=True, slots=True)
class CorrelatedGroup:
    """Assumptions with rank correlations among them."""

    names: tuple[str, ...]
    copula: GaussianCopula


class Sampler:
    """Draws blocks of trials. For one thread; its memory is used again with every block.

    Args:
        seed: of the run.
        stages: in order.
        groups: of correlated assumptions.
        parameters: for each dynamic stage, in order.
        block: trials per block.
        plan: the method and its replicates; by default independent trials.
    """

    def __init__(
        self,
        seed: int,
        stages: Sequence[Stage],
        groups: Sequence[CorrelatedGroup],
        parameters: Sequence[DynamicParameters],
        block: int,
        plan: Plan | None = None,
    ) -> None:
        names = [name for group in groups for name in group.names]
        names += [draw.name for stage in stages for draw in stage.draws if draw.name not in names]
        self._rows = np.empty((len(names), block))
        self._places = {name: row for row, name in enumerate(names)}
        self._margins = (plan or Plan.of("mc", block)).margins(seed, names)
        self._stages, self._groups, self._parameters = stages, groups, parameters
        self._block = block

    def draw(self, start: int) -> dict[str, Floats]:
        """The draws of trials `start` to `start + block - 1`, `(block,)` each; NaN for an error."""
        for margin, row in zip(self._margins, self._rows, strict=True):
            margin.uniforms(start, row)
        for group in self._groups:
            first = self._places[group.names[0]]
            group.copula.join(self._rows[first : first + len(group.names)])
        drawn: dict[str, Floats] = {}
        dynamic = iter(self._parameters)
        for stage in self._stages:
            known = next(dynamic)(drawn, self._block) if stage.dynamic else {}
            for draw in stage.draws:
                drawn[draw.name] = self._rows[self._places[draw.name]]
                draw.fill(drawn[draw.name], known)
        return drawn
