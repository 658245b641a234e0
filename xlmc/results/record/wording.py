"""Definitions in words and exact numbers, as the record, the result sheets and `xlmc check` say them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from xlmc.address import Cell
from xlmc.definitions.model import Assumption, DataRange, Filter, Parameter

if TYPE_CHECKING:
    from xlmc.run.model import Model

__all__ = ["cutoffs_text", "distribution_text", "limits_text", "notes_text", "number_text", "parameters_text", "status"]


def number_text(value: Parameter) -> str:
    """The shortest text that reads back as the same number: `0.95`, `6661`; or the cell that holds it."""
    return str(value) if isinstance(value, Cell) else repr(float(value)).removesuffix(".0")


def parameters_text(assumption: Assumption) -> str:
    """`Low 6661, High 6861`; `Data Inputs!Q2:R9` for a distribution built from data."""
    given = assumption.parameters
    parts = [
        f"{spec.heading} {number_text(given[spec.key])}" for spec in assumption.family.parameters if spec.key in given
    ]
    return ", ".join(parts if assumption.data is None else [*parts, _data_text(assumption.data)])


def _data_text(data: DataRange) -> str:
    weights = ", cumulative weights" * data.cumulative
    bandwidth = "" if data.bandwidth is None else f", Bandwidth {number_text(data.bandwidth)}"
    return f"Data {data.text or data.area}{weights}{bandwidth}"


def cutoffs_text(lower: Parameter | None, upper: Parameter | None) -> str:
    """`below 0.5, above 0.9`: what is cut off; empty where nothing is."""
    cutoffs = ("below", lower), ("above", upper)
    return ", ".join(f"{side} {number_text(cutoff)}" for side, cutoff in cutoffs if cutoff is not None)


def distribution_text(assumption: Assumption) -> str:
    """`Normal: Mean 0.77, Std dev 0.05; cut off below 0.6`."""
    cutoffs = cutoffs_text(assumption.lower_cutoff, assumption.upper_cutoff)
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
    return " and ".join(f"{relation} {number_text(bound)}" for relation, bound in limits if bound is not None) or "TRUE"


def notes_text(notes: Mapping[str, str]) -> str:
    """The table's other columns: `Symbol: w1; Cell name: w_1`."""
    return "; ".join(f"{heading}: {text}" for heading, text in notes.items())


def status(model: Model, name: str, frozen: bool) -> str:
    """What a run does with the assumption: `drawn`, `frozen`, or `not needed` by any forecast or filter."""
    if frozen:
        return "frozen"
    return "drawn" if name in model.draws else "not needed"
