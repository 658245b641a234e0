"""Sampling: seeded streams, Monte Carlo, rank correlation."""

from xlmc.sampling.copula import GaussianCopula
from xlmc.sampling.draws import CorrelatedGroup, Draw, DynamicParameters, MonteCarlo, Stage
from xlmc.sampling.streams import GENERATOR, Stream

__all__ = [
    "GENERATOR",
    "CorrelatedGroup",
    "Draw",
    "DynamicParameters",
    "GaussianCopula",
    "MonteCarlo",
    "Stage",
    "Stream",
]
