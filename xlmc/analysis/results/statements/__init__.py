"""Definitions and results in words, and certainties: pure functions of a run, for sheets, pages and programs alike.

*Certainty* is Crystal Ball's word: the share of the accepted trials in a range.
"""
