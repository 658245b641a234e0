"""Sampling: seeded streams; Monte Carlo, Latin hypercube and scrambled Sobol; rank correlation."""

from xlmc.sampling.copula import GaussianCopula
from xlmc.sampling.draws import CorrelatedGroup, Draw, DynamicParameters, Sampler, Stage
from xlmc.sampling.plan import METHODS, REPLICATES, Margin, Plan
from xlmc.sampling.streams import GENERATOR, Stream

__all__ = [
    "GENERATOR",
    "METHODS",
    "REPLICATES",
    "CorrelatedGroup",
    "Draw",
    "DynamicParameters",
    "GaussianCopula",
    "Margin",
    "Plan",
    "Sampler",
    "Stage",
    "Stream",
]
