"""Find the result sheets of a workbook again: by xlmc's mark and their name, or by what stands on them."""

from __future__ import annotations

import re
from collections.abc import Collection
from typing import TYPE_CHECKING, Final

from xlmc.replay.closeness import Closeness
from xlmc.workbook.inject import marked_names

if TYPE_CHECKING:
    from xlmc.workbook.model import Sheet, Workbook

__all__ = ["matched"]

_NUMBERED: Final = re.compile(r" \(\d+\)$")
_SAMPLE: Final = 400
"""Cells of a sheet that are looked at to know it again."""

_ENOUGH: Final = 0.5
"""The share of them that must be the same on a sheet of another name."""

_REWRITTEN: Final = Closeness(rewritten=True)


def matched(workbook: Workbook, built: Workbook) -> dict[str, Sheet]:
    """The sheets of a file that are those the run writes, by the names that the run gives them.

    Args:
        workbook: the file.
        built: the result sheets of the run, and nothing else.
    """
    found = _by_mark(workbook, built)
    for name in built.sheets:
        if name not in found:
            taken = {sheet.name for sheet in found.values()}
            likest = _likest(built.sheets[name], workbook, taken)
            if likest is not None:
                found[name] = likest
    return found


def _by_mark(workbook: Workbook, built: Workbook) -> dict[str, Sheet]:
    """Those with a mark; `Results (2)` is Results in a workbook that has a sheet of that name."""
    marked = [name for name in marked_names(workbook.names) if name in workbook.sheets]
    names = {name if name in built.sheets else _NUMBERED.sub("", name): name for name in marked}
    return {name: workbook.sheets[names[name]] for name in built.sheets if name in names}


def _likest(expected: Sheet, workbook: Workbook, taken: Collection[str]) -> Sheet | None:
    """The sheet that shares most cells with the expected one; one of its name may share fewer than half."""
    shares = {name: _share(expected, workbook.sheets[name]) for name in workbook.sheets if name not in taken}
    best = max(shares, key=lambda name: (shares[name], name == expected.name), default=None)
    if best is not None and shares[best] > _ENOUGH:
        return workbook.sheets[best]
    return workbook.sheets[expected.name] if shares.get(expected.name, 0.0) > 0.0 else None


def _share(expected: Sheet, sheet: Sheet) -> float:
    """The share of the expected sheet's cells that another one holds in the same places; of some hundreds of them."""
    places = [place for place, content in expected.cells.items() if content.value is not None]
    places = places[:: max(1, len(places) // _SAMPLE)]
    same = sum(
        place in sheet.cells and _REWRITTEN.equal(sheet.cells[place].value, expected.cells[place].value)
        for place in places
    )
    return same / len(places) if places else 0.0
