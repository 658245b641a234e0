"""Definitions in words and exact numbers, as the record, the result sheets and `xlmc check` say them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from xlmc.definitions.model import Assumption, DataRange, Filter, Parameter

if TYPE_CHECKING:
    from xlmc.run.model import Model

__all__ = ["cutoffs_text", "distribution_text", "limits_text", "notes_text", "number_text", "parameters_text", "status"]


def number_text(value: float) -> str:
    """The shortest text that reads back as the same number: `0.95`, `6661`."""
    return repr(float(value)).removesuffix(".0")


def bound_text(bound: Parameter) -> str:
    """A number, or the cell that holds it."""
    return number_text(bound) if isinstance(bound, float | int) else str(bound)


def parameters_text(assumption: Assumption) -> str:
    """`Low 6661, High 6861`; `Data Inputs!Q2:R9` for a distribution built from data."""
    given = assumption.parameters
    parts = [
        f"{spec.heading} {bound_text(given[spec.key])}" for spec in assumption.family.parameters if spec.key in given
    ]
    return ", ".join(parts if assumption.data is None else [*parts, _data_text(assumption.data)])


def _data_text(data: DataRange) -> str:
    weights = ", cumulative weights" * data.cumulative
    bandwidth = "" if data.bandwidth is None else f", Bandwidth {bound_text(data.bandwidth)}"
    return f"Data {data.text or data.area}{weights}{bandwidth}"


def cutoffs_text(assumption: Assumption) -> str:
    """`below 0.5, above 0.9`: what is cut off; empty where nothing is."""
    cutoffs = (("below", assumption.lower_cutoff), ("above", assumption.upper_cutoff))
    return ", ".join(f"{side} {bound_text(cutoff)}" for side, cutoff in cutoffs if cutoff is not None)


def distribution_text(assumption: Assumption) -> str:
    """`Normal: Mean 0.77, Std dev 0.05; cut off below 0.6`."""
    cutoffs = cutoffs_text(assumption)
    ending = f"; cut off {cutoffs}" if cutoffs else ""
    return f"{assumption.distribution}: {parameters_text(assumption)}{ending}"


def limits_text(filter_: Filter) -> str:
    """`at least 0 and below 1`; `TRUE` where the filter has no limits."""
    limits = (
        ("at least", filter_.at_least),
        ("above", filter_.above),
        ("at most", filter_.at_most),
        ("below", filter_.below),
    )
    return " and ".join(f"{relation} {bound_text(bound)}" for relation, bound in limits if bound is not None) or "TRUE"


def notes_text(notes: Mapping[str, str]) -> str:
    """The table's other columns: `Symbol: w1; Cell name: w_1`."""
    return "; ".join(f"{heading}: {text}" for heading, text in notes.items())


def status(model: Model, assumption: Assumption) -> str:
    """What a run does with the assumption: `drawn`, `frozen`, or `not needed` by any forecast or filter."""
    if assumption.frozen:
        return "frozen"
    return "drawn" if assumption in model.live else "not needed"
