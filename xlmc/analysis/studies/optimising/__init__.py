"""Optimisation: which decisions are best, and how sure that is."""

from xlmc.analysis.studies.optimising.optimise import Held, OptimiseArguments, Optimised, optimise
from xlmc.analysis.studies.optimising.selection import Rival

__all__ = ["Held", "OptimiseArguments", "Optimised", "Rival", "optimise"]
