"""A template filled in with the numbers of a published example."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from templates.description import EvidenceRow, GuideSection, Input, Template

__all__ = ["filled"]


Given = float | tuple[float, float]
"""A number; or, of an assumption, the ends of its range, whose middle its cell shows."""


def filled(
    template: Template,
    title: str,
    subtitle: str,
    numbers: Mapping[str, Given],
    source: str,
    about: GuideSection,
    readings: Mapping[str, tuple[float, float]] | None = None,
) -> Template:
    """The template with other numbers. An assumption that is one number is held, as the source gives no range.

    Args:
        template: in one system of units.
        title: of the workbook.
        subtitle: of the workbook.
        numbers: symbol -> what any input cell has; the others keep theirs.
        source: what to write beside each of these inputs.
        about: takes the place of the guide's first section.
        readings: symbol -> (reading, plus or minus) of the evidence of that quantity.

    Raises:
        KeyError: there is no such input, or no such evidence.
    """
    readings = readings or {}
    known = {"input": [row.symbol for row in template.inputs], "evidence": [row.symbol for row in template.evidence]}
    for kind, symbols in (("input", numbers), ("evidence", readings)):
        if unknown := set(symbols) - set(known[kind]):
            raise KeyError(f"no {kind} is called {', '.join(sorted(unknown))}")

    def with_numbers(inputs: tuple[Input, ...]) -> tuple[Input, ...]:
        return tuple(_given(each, numbers[each.symbol], source) if each.symbol in numbers else each for each in inputs)

    return replace(
        template,
        title=title,
        subtitle=subtitle,
        assumptions=with_numbers(template.assumptions),
        constants=with_numbers(template.constants),
        optional=with_numbers(template.optional),
        waiting=with_numbers(template.waiting),
        evidence=tuple(
            _read(each, *readings[each.symbol]) if each.symbol in readings else each for each in template.evidence
        ),
        correlations=tuple(row for row in template.correlations if not {row.first, row.second} & set(numbers)),
        guide=(about, *template.guide[1:]),
    )


def _given(row: Input, number: Given, source: str) -> Input:
    if isinstance(number, tuple):
        low, high = number
        ends = {"Low": low, "High": high}
        return replace(row, base=(low + high) / 2, source=source, parameters=ends, distribution="Uniform")
    if not row.parameters:
        return replace(row, base=number, source=source)
    held = {"Low": number, "High": number}
    return replace(row, base=number, source=source, parameters=held, distribution="Uniform", frozen=True)


def _read(row: EvidenceRow, reading: float, off_by: float) -> EvidenceRow:
    if row.error != "Uniform":
        return row
    return replace(row, reading=reading, off_by={"Plus or minus": off_by})
