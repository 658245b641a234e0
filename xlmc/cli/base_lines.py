"""What `xlmc check` says of the base case, before anything else: checks that fail, cells in error."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from xlmc.cli.terminal import paragraph, say
from xlmc.errors import sentence

if TYPE_CHECKING:
    from xlmc.run.cell_errors import BaseErrors
    from xlmc.run.model import Model

__all__ = ["show_base_case"]

_MOST = 12
"""Cells of one kind that are listed."""


def show_base_case(model: Model) -> list[str]:
    """Print the checks that fail and the cells in error; return why the answer must not be used as it stands."""
    from xlmc.run.cell_errors import errors_at_base
    from xlmc.run.checking import base_checks

    failing = [check.fault for check in base_checks(model) if check.holds is False]
    errors = errors_at_base(model)
    lines = [sentence(f"{fault[0].upper()}{fault[1:]}") for fault in failing]
    lines += _error_lines(model, errors)
    if lines:
        say(f"{model.workbook.name}: at the base case, every assumption at its cell's own value\n")
    for line in lines:
        say(paragraph(line, hanging="  "))
    if lines:
        say()
    if not errors.answers:
        return failing
    cell, code = next(iter(errors.roots.items()))
    return [*failing, f"at the base case {cell} is {code.text}, and so is a cell that was asked for"]


def _error_lines(model: Model, errors: BaseErrors) -> Iterator[str]:
    """The cells that errors come from with their formulas, then the cells that have theirs from these."""
    from xlmc.results.record.cells import content_text

    handled = "" if errors.answers else " (handled: no forecast, filter or check is an error)"
    for cell, code in list(errors.roots.items())[:_MOST]:
        yield f"{cell} {code.text}{handled}: {content_text(model.workbook, cell)}"
    if len(errors.roots) > _MOST:
        yield f"… and {len(errors.roots) - _MOST:,} more cells in error of themselves"
    if errors.others:
        named = ", ".join(f"{cell} {code.text}" for cell, code in list(errors.others.items())[:_MOST])
        more = f" and {len(errors.others) - _MOST:,} more" if len(errors.others) > _MOST else ""
        yield f"Cells that have their error from these: {named}{more}."
