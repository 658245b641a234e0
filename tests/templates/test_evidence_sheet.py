"""Sheet Evidence: rows that wait for a reading, and what one does."""

from __future__ import annotations

import math
from types import MappingProxyType

import numpy as np
import pytest
from committed_books import BOOKS
from recalculated_books import RECALCULATED
from simulated import simulated
from typed_cells import model_of, named_cells, with_typed

from xlmc.engine.engines import ENGINES
from xlmc.excel.address import Cell
from xlmc.montecarlo.definitions.definitions_reader import read_definitions

HEADERS = "Name Cell Units Reading Error/Plus or minus/Std dev/Percent/Resolution/Use/Source"


@pytest.fixture(scope="module")
def read_in(read):
    """`read_in(name, row, cells)`: the model with cells of a row of Evidence, by column, and `typed` values."""

    def make(name, label, cells, typed=MappingProxyType({})):
        book = read(name)
        rows = {at[0]: content.value for at, content in book.sheets["Evidence"].cells.items() if at[1] == 1}
        [row] = [row for row, shown in rows.items() if row > 5 and label in shown]
        readings = {Cell("Evidence", row, column): value for column, value in cells.items()}
        return model_of(with_typed(book, typed | readings))

    return make


def test_rows_are_as_described_and_off(described, opened, read):
    result = [name for name in BOOKS if described[name].evidence]
    assert len(result) == 49
    alike = [name for name in result if name in RECALCULATED]
    assert len(alike) > 7
    for name in alike:
        book, template = opened(BOOKS[name]), described[name]
        sheet = book["Evidence"]
        header, *rows = sheet[sheet.tables["xlmc_evidence"].ref]
        assert "/".join(cell.value for cell in header).replace("/", " ", 4) == HEADERS
        for row, reading in zip(rows, template.evidence, strict=True):
            [(at, place)] = book.defined_names[reading.symbol].destinations
            assert row[1].value == f"={at}!{place.replace('$', '')}"
            assert row[3].value == reading.reading
            assert row[10].value
        used = [each.used for each in read_definitions(read(name), ENGINES).evidence]
        assert used == [row.reading is not None and row.use for row in template.evidence], name


CASES = [
    # Template, row, its cells (4 reading, 6 to 9 how far off), the forecast that moves, how
    (
        "planar-impact",
        "Vehicle 1 EDR delta-V, forward",
        {4: -12},
        "Vehicle 1 delta-V",
        lambda x: 0.9 * x.min() <= 12.31,
    ),
    ("momentum", "Vehicle 1 EDR delta-V, forward", {4: -12}, "Vehicle 1 delta-V", lambda x: x.min() > 0),
    ("airborne", "gouge", {4: -20, 6: 1}, "Direction of flight at landing", lambda x: np.abs(x + 20).max() <= 1),
    (
        "edr-speed",
        "Skid marks",
        {4: 95, 6: 2},
        "Vehicle way from brake on to the impact, at least",
        lambda x: np.ptp(x) <= 4,
    ),
    ("pedestrian", "Throw and marks", {4: 0, 7: 1}, "Vehicle impact speed, from the throw", lambda x: x.std() < 1.7),
]


@pytest.mark.parametrize(("template", "row", "reading", "forecast", "holds"), CASES)
def test_a_reading_keeps_what_agrees_with_it(template, row, reading, forecast, holds, read_in, run_of):
    with_it, without = simulated(read_in(template, row, reading), 20_000), run_of(template)
    assert 0 < with_it.accepted < without.accepted
    assert holds(with_it[forecast].values)


def test_a_recorder_away_from_the_cg_reads_the_turning_too(cells):
    """The velocity of a point is that of the CG and the rate of turning times its lever arm."""
    given = {"xs_1": 30, "ys_1": 24}
    wanted = ["edr1_long", "edr1_right", "dV1_long", "dV1_right", "d_omega_1", "spin_1", "omega1_f", "m_1"]
    result = {symbol: value.item() for symbol, value in cells("planar-impact", given, wanted).items()}
    to_mph = 3600 / 5280
    assert result["edr1_long"] == pytest.approx(result["dV1_long"] + result["d_omega_1"] * 24 / 12 * to_mph, rel=1e-12)
    assert result["edr1_right"] == pytest.approx(
        result["dV1_right"] - result["d_omega_1"] * 30 / 12 * to_mph, rel=1e-12
    )
    assert math.isnan(result["spin_1"])
    turned = {"phi_1": -40, "mu_R_1": 0.35, "R_1": 11, "I_1": 4960, "g": 32.174}
    spin = {symbol: value.item() for symbol, value in cells("planar-impact", turned, wanted).items()}
    work = 0.35 * spin["m_1"] * 32.174 * 11 * math.radians(40)
    assert spin["spin_1"] == pytest.approx(4960 * spin["omega1_f"] ** 2 / work, rel=1e-12)


REAR = {"alpha_1": (89, 91), "alpha_2": (77, 79), "beta_1": (89, 91), "beta_2": (73, 74.2), "s_1": (58, 59)}
REAR |= {"s_2": (77, 79), "f_1": (0.69, 0.71), "f_2": (0.69, 0.71), "w_1": (2990, 3010), "w_2": (2990, 3010)}
"""Both northward: the second, faster, runs into the first from behind."""


def test_a_blow_from_behind_is_compared_as_an_angle(read, read_in):
    row, pdof = "Vehicle 1 direction of force", "Vehicle 1 PDOF, counter-clockwise"
    at = named_cells(read("momentum"))
    ranges = {
        Cell("Inputs", at[symbol].row, column): end
        for symbol, ends in REAR.items()
        for column, end in zip((7, 8), ends, strict=True)
    }
    rear = model_of(with_typed(read("momentum"), ranges))
    apart = simulated(rear, 20_000)[pdof].values
    assert np.mean(apart > 170) > 0.3
    assert np.mean(apart < -170) > 0.3
    kept = set()
    for reading in (179, -181, 539):
        run = simulated(read_in("momentum", row, {4: reading}, ranges), 20_000)
        kept.add(run.accepted)
        assert abs(run[pdof].values - reading).max() < 15
    assert len(kept) == 1
    assert min(kept) > 0.95 * 20_000  # within some 4° of 179, σ 12.6: exp(-z²/2) > .95
    unused = simulated(read_in("momentum", row, {4: 180, 10: False}, ranges), 20_000)
    np.testing.assert_allclose(unused[pdof].values, apart % 360, atol=1e-9)
