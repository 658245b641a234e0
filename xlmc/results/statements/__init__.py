"""Results in words and as certainties: pure functions of a run, for sheets, pages and programs alike.

*Certainty* is Crystal Ball's word: the share of the accepted trials in a range.
"""

from xlmc.results.statements.certainty import Certainty, certainties
from xlmc.results.statements.digits import RoundedRange, percent_text, rounded_range
from xlmc.results.statements.pairs import PAIRS, Pair, pairs_of
from xlmc.results.statements.sentences import MEANING, Statement, statements

__all__ = [
    "MEANING",
    "PAIRS",
    "Certainty",
    "Pair",
    "RoundedRange",
    "Statement",
    "certainties",
    "pairs_of",
    "percent_text",
    "rounded_range",
    "statements",
]
