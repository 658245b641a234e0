"""Optimisation: which decisions are best, and how sure that is."""

from xlmc.analysis.studies.optimising.optimise import OptimiseArguments, Optimised, RequirementResult, optimise
from xlmc.analysis.studies.optimising.selection import Rival

__all__ = ["OptimiseArguments", "Optimised", "RequirementResult", "Rival", "optimise"]
