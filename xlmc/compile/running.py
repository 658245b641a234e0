"""Running totals: `SUM(B$1:B9)` beside `SUM(B$1:B8)` is that and one cell more, to the last bit.

Sums are folded from left to right, so that the sum of a longer range begins with that of the shorter. Filled down over
n rows they then cost n steps instead of n²/2. (Not so the largest: that of no numbers at all is 0.)
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Final

from xlmc.address import Area
from xlmc.compile.dag import Apply, Dag, Range
from xlmc.functions import Function

__all__ = ["RunningTotals"]

_SHORTEST: Final = 16
"""Cells of a range worth looking up."""


class RunningTotals:
    """The sums of long ranges met so far."""

    def __init__(self, dag: Dag) -> None:
        self._dag = dag
        self._known: dict[tuple[Function, tuple[int, ...]], int] = {}
        self._areas: dict[Area, int] = {}

    def sum_of(self, function: Function, area: Area, cells: Callable[[Area], int]) -> int | None:
        """The sum of a long column or row of which all but the last cell was added up before; None for others.

        Args:
            function: SUM.
            area: its only argument.
            cells: gives the node of an area, which takes time for each of its cells.
        """
        if min(area.rows, area.columns) > 1 or max(area.rows, area.columns) < _SHORTEST:
            return None
        if area in self._areas:
            return self._areas[area]
        down, right = (1, 0) if area.columns == 1 else (0, 1)
        before = self._areas.get(replace(area, bottom=area.bottom - down, right=area.right - right))
        if before is None:
            found = self.made(function, (cells(area),))
        else:
            last = cells(Area(area.sheet, area.bottom, area.right, area.bottom, area.right))
            found = self._dag.add(Apply(function, (before, last)))
        self._areas[area] = found
        return found

    def made(self, function: Function, arguments: tuple[int, ...]) -> int:
        """The node of a function whose arguments are one set."""
        node = Apply(function, arguments)
        cells = self._column(function, arguments)
        if cells is None:
            return self._dag.add(node)
        before = self._known.get((function, cells[:-1]))
        if before is not None:
            node = Apply(function, (before, self._dag.add(Range(((cells[-1],),)))))
        self._known[function, cells] = place = self._dag.add(node)
        return place

    def _column(self, function: Function, arguments: tuple[int, ...]) -> tuple[int, ...] | None:
        """The cells of the only argument where it is one long column."""
        if function.name != "SUM" or len(arguments) != 1:
            return None
        node = self._dag.nodes[arguments[0]]
        if not isinstance(node, Range) or len(node.rows) < _SHORTEST or len(node.rows[0]) > 1:
            return None
        return tuple([cell for (cell,) in node.rows])
