"""Definitions in words: those of the record, the result sheets and `xlmc check`."""

from __future__ import annotations

from collections.abc import Mapping

from xlmc.excel.address import Cell
from xlmc.montecarlo.definitions.definitions import CUTOFFS, Assumption, DataRange, Filter, Parameter
from xlmc.montecarlo.definitions.evidence import ERRORS, SIZES, Evidence, Within
from xlmc.montecarlo.definitions.forms import PLAIN, Form
from xlmc.montecarlo.number_text import exact_text, styled_text

__all__ = [
    "cutoffs_text",
    "distribution_text",
    "evidence_text",
    "given_text",
    "limits_text",
    "notes_text",
    "parameters_text",
    "plain_text",
]


def plain_text(value: Parameter) -> str:
    """Return the shortest text that reads back as the same number: `0.95`, `6661`; or the cell that holds it."""
    return str(value) if isinstance(value, Cell) else repr(float(value)).removesuffix(".0")


def given_text(value: Parameter, form: Form = PLAIN) -> str:
    """Return a number as people read it, with all of its digits: `6,661`, a date as its cell shows it; or the cell that
    holds it.
    """
    if isinstance(value, Cell):
        return str(value)
    return exact_text(value, typed=True) if form is PLAIN else form.number(value, typed=True)


def parameters_text(assumption: Assumption) -> str:
    """`Low 6,661, High 6,861`; `Low 180,000 (=Estimate!B2)` where a formula gives it; `Data Inputs!Q2:R9` of data."""
    parts = []
    for key, heading in assumption.headings.items():
        if key not in CUTOFFS:
            parts.append(f"{heading} {assumption.text_of(key)}")
    if assumption.data is not None:
        parts.append(_data_text(assumption.data))
    return ", ".join(parts)


def _data_text(data: DataRange) -> str:
    weights = ", cumulative weights" * data.cumulative
    bandwidth = "" if data.bandwidth is None else f", Bandwidth {given_text(data.bandwidth)}"
    return f"Data {data.text or data.area}{weights}{bandwidth}"


def cutoffs_text(assumption: Assumption) -> str:
    """`below 0.5, above 0.9`: what is cut off; empty where nothing is."""
    sides = {"lower_cutoff": "below", "upper_cutoff": "above"}
    return ", ".join(f"{sides[key]} {assumption.text_of(key)}" for key in assumption.cutoffs)


def distribution_text(assumption: Assumption) -> str:
    """Write a distribution: `Normal: Mean 0.77, Std dev 0.05; cut off below 0.6`; `held at 55` of a row without one."""
    given = assumption.given
    if assumption.frozen and given.keys() == {"low", "high"} and given["low"] == given["high"]:
        return f"held at {assumption.text_of('low')}"
    cutoffs = cutoffs_text(assumption)
    ending = f"; cut off {cutoffs}" if cutoffs else ""
    return f"{assumption.distribution}: {parameters_text(assumption)}{ending}"


def limits_text(filter_: Filter) -> str:
    """`at least 0 and below 1`; `TRUE` where it has no limits; what evidence says, where it is some; that it is off."""
    if not filter_.used:
        return "not used: Use is off"
    if filter_.evidence is not None:
        return evidence_text(filter_.evidence)
    limits = ("at_least", "above", "at_most", "below")
    messages = [
        f"{key.replace('_', ' ')} {filter_.text_of(key)}" for key in limits if getattr(filter_, key) is not None
    ]
    return " and ".join(messages) or "TRUE"


def evidence_text(evidence: Evidence) -> str:
    """Write evidence: `reads 12, normal (Std dev 0.6)`; `reads 12, instrument (Percent 10): from 10.9091 to
    13.3333`.
    """
    if not evidence.used or evidence.reading is None:
        return f"not used: {evidence.unused}"
    known = None if any(evidence.cells) else evidence.law
    sizes = ", ".join(f"{SIZES[key]} {given_text(value)}" for key, value in evidence.sizes.items())
    ends_text = ""
    if isinstance(known, Within):
        ends = [("from", known.low), ("to", known.high)]
        ends_text = ": " + " ".join(f"{word} {_rough(end, evidence.form)}" for word, end in ends if end is not None)
    given, weights = f" ({sizes})" if sizes else "", ", as weights" if evidence.weighed else ""
    reading = given_text(evidence.reading, evidence.form)
    return f"reads {reading}, {ERRORS[evidence.error].lower()}{given}{ends_text}{weights}"


def _rough(value: float, form: Form) -> str:
    return styled_text(value, ".6g") if form is PLAIN else form.rough(value)


def notes_text(notes: Mapping[str, str]) -> str:
    """Write the table's other columns: `Symbol: w1; Cell name: w_1`."""
    return "; ".join(f"{heading}: {text}" for heading, text in notes.items())
