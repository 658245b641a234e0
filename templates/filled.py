"""A template filled in with the numbers of a published example."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from templates.description import GuideSection, Input, Template

__all__ = ["filled"]


def filled(
    template: Template, title: str, subtitle: str, numbers: Mapping[str, float], source: str, about: GuideSection
) -> Template:
    """The template with other numbers. An assumption among them is held, as the source gives no range.

    Args:
        template: in one system of units.
        title: of the workbook.
        subtitle: of the workbook.
        numbers: symbol -> value of any input cell; the others keep theirs.
        source: what to write beside each of these inputs.
        about: takes the place of the guide's first section.

    Raises:
        KeyError: there is no such input.
    """
    unknown = set(numbers) - {given.symbol for given in template.inputs}
    if unknown:
        raise KeyError(f"no input is called {', '.join(sorted(unknown))}")

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
        correlations=tuple(row for row in template.correlations if not {row.first, row.second} & set(numbers)),
        guide=(about, *template.guide[1:]),
    )


def _given(row: Input, number: float, source: str) -> Input:
    if not row.parameters:
        return replace(row, base=number, source=source)
    held = {"Low": number, "High": number}
    return replace(row, base=number, source=source, parameters=held, distribution="Uniform", frozen=True)
