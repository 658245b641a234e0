"""Graph of formulas → one callable over blocks of trials, by the engine of one's choice."""

from xlmc.evaluation.engine import Column, Evaluator, Program, Target

__all__ = ["Column", "Evaluator", "Program", "Target"]
