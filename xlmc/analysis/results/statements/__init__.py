"""Definitions and results in words, and certainties: pure functions of a run, for sheets, pages and programs alike.

*Certainty* is Crystal Ball's word: the share of the accepted trials in a range.
"""

from xlmc.analysis.results.statements.pairs import PAIRS, Pair, pairs_of
from xlmc.analysis.results.statements.sentences import (
    Certainty,
    Statement,
    certainties,
    meaning,
    stated_range,
    statements,
)
from xlmc.analysis.results.statements.significant_digits import RoundedRange, percent_text, reach_text

__all__ = [
    "PAIRS",
    "Certainty",
    "Pair",
    "RoundedRange",
    "Statement",
    "certainties",
    "meaning",
    "pairs_of",
    "percent_text",
    "reach_text",
    "stated_range",
    "statements",
]
