"""Definitions in words: one phrasing for the command line, the sheets and the record."""

from __future__ import annotations

from xlmc.address import Cell
from xlmc.definitions import Assumption, Filter
from xlmc.definitions.model import Parameter
from xlmc.distributions import FAMILIES

__all__ = ["distribution_text", "limits_text", "number_text", "share_text"]


def number_text(value: Parameter) -> str:
    """`0.6`; a cell as `=Inputs!B7`."""
    return f"={value}" if isinstance(value, Cell) else f"{value:.10g}"


def share_text(share: float) -> str:
    """`0.51 -> '51 %'`."""
    return f"{100 * share:.10g} %"


def distribution_text(assumption: Assumption) -> str:
    """`Uniform: Low 181, High 191`, with the cutoffs, if any."""
    family = FAMILIES[assumption.distribution]
    parts = [f"{spec.heading} {number_text(assumption.parameters[spec.key])}" for spec in family.parameters]
    if assumption.lower_cutoff is not None:
        parts.append(f"cut below {number_text(assumption.lower_cutoff)}")
    if assumption.upper_cutoff is not None:
        parts.append(f"cut above {number_text(assumption.upper_cutoff)}")
    return f"{assumption.distribution}: {', '.join(parts)}"


def limits_text(filter_: Filter) -> str:
    """`at least 0, below 1`; `TRUE` for a filter without limits."""
    limits = {
        "at least": filter_.at_least,
        "above": filter_.above,
        "at most": filter_.at_most,
        "below": filter_.below,
    }
    given = [f"{words} {number_text(value)}" for words, value in limits.items() if value is not None]
    return ", ".join(given) or "TRUE"
