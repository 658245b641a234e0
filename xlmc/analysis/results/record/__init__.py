"""The record of a run: what it was a function of, with versions, definitions, counts, and how to repeat it."""

from __future__ import annotations

from xlmc.analysis.results.record.make import changed_from_of, make_record, recorded_feeds, recorded_functions
from xlmc.analysis.results.record.record_parts import Entry, Record, RecordTable, Section, Value

__all__ = [
    "Entry",
    "Record",
    "RecordTable",
    "Section",
    "Value",
    "changed_from_of",
    "make_record",
    "recorded_feeds",
    "recorded_functions",
]
