"""Restitution against closing speed: the published ranges, straight between points, as a limit and as a likelihood."""

from __future__ import annotations

import numpy as np
import pytest
from simulated import simulated
from typed_cells import model_of, named_cells, with_typed

from xlmc.excel.address import Cell

EDITIONS = [name + units for name in ("collinear", "planar-impact") for units in ("", "-si")]
USE = 10
"""Column of sheet Evidence."""


@pytest.mark.parametrize("name", EDITIONS)
def test_the_range_is_that_of_the_points_and_straight_between_them(name, cells, shown):
    points = [[shown(name)[f"{symbol}_{k}"] for k in (1, 2, 3)] for symbol in ("Vc_curve", "e_from", "e_to")]
    restitution, speed = ("e", "closing") if name.startswith("collinear") else ("e_n", "approach")
    speed = f"{speed}_{'kmh' if name.endswith('-si') else 'mph'}"
    scale = np.geomspace(0.05, 30, 200)
    given = (
        {f"f_{j}": 0.7 * scale**2 for j in (1, 2)}
        if name.startswith("planar")
        else {"V1_before": scale * 10, "known": 1}
    )
    result = cells(name, given, [restitution, speed, "e_least", "e_most", "e_off"])
    assert result[speed].min() < points[0][0] < points[0][2] < result[speed].max()
    for symbol, ends in (("e_least", points[1]), ("e_most", points[2])):
        np.testing.assert_allclose(result[symbol], np.interp(result[speed], points[0], ends), rtol=1e-12)
    middle, wide = (result["e_least"] + result["e_most"]) / 2, result["e_most"] - result["e_least"]
    np.testing.assert_allclose(result[restitution], middle + result["e_off"] * wide / 4, rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("row", ["within the published range", "by the published scatter"])
def test_a_row_that_is_used_keeps_what_the_curve_allows(row, read, cells):
    book = read("planar-impact")
    rows = {at[0]: content.value for at, content in book.sheets["Evidence"].cells.items() if at[1] == 1}
    (line,) = [number for number, name in rows.items() if isinstance(name, str) and row in name]
    symbols = {cell: symbol for symbol, cell in named_cells(book).items()}
    use = Cell("Evidence", line, USE)
    free = simulated(model_of(book), 50_000)
    kept = simulated(model_of(with_typed(book, {use: True})), 50_000, evidence="rejection")
    drawn = {symbols[each.cell]: free.inputs[each.name] for each in free.model.live}
    off = cells("planar-impact", drawn, ["e_off"])["e_off"]
    if "range" in row:
        np.testing.assert_array_equal(kept.trial_index, free.trial_index[np.abs(off) <= 2])
        assert 0 < kept.accepted < free.accepted
    else:
        share = np.exp(-(off**2) / 2)
        error = np.sqrt(np.sum(share * (1 - share)))
        assert abs(kept.accepted - share.sum()) < 4 * error
