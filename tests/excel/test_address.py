"""Cells and areas."""

from __future__ import annotations

from xlmc.excel.address import Area, Cell


def test_an_area_holds_both_of_its_corners():
    area = Area("S", 2, 3, 5, 4)
    assert (area.rows, area.columns) == (4, 2)
    assert len([*area.cells()]) == 8
    assert {Cell("S", 2, 3), Cell("S", 5, 4)} <= {*area.cells()}
    assert Cell("S", 5, 4) in area
    assert Cell("S", 6, 4) not in area
    assert Cell("T", 2, 3) not in area
