from __future__ import annotations

import books
import hand_written_skid
import numpy as np
import pytest
from simulated import simulated

from xlmc.montecarlo.distributions.spelling import name_key
from xlmc.montecarlo.model.loading import load

CELLS = 20
OF_THE_ANSWER = 3
"""Formula cells beside the steps: two of the row before the first step, and the forecast."""


@pytest.fixture(scope="module")
def march(tmp_path_factory):
    path = tmp_path_factory.mktemp("march") / "march.xlsx"
    books.write_march(path, CELLS)
    return load(path)


def test_the_forecast_needs_every_cell(march):
    assert len(march.needed.graph.formulas) == CELLS + OF_THE_ANSWER
    assert len(march.live) == len(books.MARCH)


def test_the_march_has_the_kinds_of_formulas_that_it_is_said_to_have(march):
    text = " ".join(march.workbook.content(cell).formula.text for cell in march.needed.graph.formulas)
    assert all(f"{name}(" in text for name in ("IF", "SUM", "VLOOKUP", "INDEX", "MATCH", "SIN", "COS", "ATAN", "SQRT"))


def test_both_engines_agree_on_the_march(march):
    trials = 2
    fast = simulated(march, trials, 1, engine="numpy")
    slow = simulated(march, trials, 1, engine="formulas")
    name = march.forecasts[0].name
    assert fast[name].values.size == trials
    np.testing.assert_allclose(fast[name].values, slow[name].values, rtol=1e-12)


def test_the_road_is_seeded(tmp_path):
    paths = [tmp_path / name for name in ("a.xlsx", "b.xlsx", "c.xlsx")]
    for path, seed in zip(paths, (1, 1, 2), strict=True):
        books.write_march(path, 20, seed)
    base = {name_key(name): value for name, _, value, *_ in books.MARCH}
    names = {a.name: base[name_key(a.name)] for a in load(paths[0]).live}
    first, same, other = (load(path).function(names)["All steps"][0] for path in paths)
    assert first == same != other


def test_the_skid_sheet_is_what_is_written_by_hand(tmp_path):
    path = tmp_path / "skid.xlsx"
    books.write_skid(path)
    model = load(path)
    low, high = hand_written_skid.LOW[:, None], hand_written_skid.HIGH[:, None]
    inputs = low + (high - low) * np.random.default_rng(3).random((3, 500))
    columns = {name: column for (name, *_), column in zip(books.SKID, inputs, strict=True)}
    result = model.function(columns)["Speed, mph"]
    for evaluate, _ in hand_written_skid.KERNELS.values():
        np.testing.assert_allclose(result, evaluate(inputs.copy())[0], rtol=1e-13)
    assert [a.parameters for a in model.assumptions] == [{"low": lo, "high": hi} for *_, lo, hi in books.SKID]


def test_hand_written_runs_of_the_skid_keep_what_they_say():
    for kernel, (evaluate, _) in hand_written_skid.KERNELS.items():
        kept = hand_written_skid.simulate(5_000, 1, 2_048, kernel, keep_draws=True)
        assert kept.index.tolist() == list(range(5_000))
        np.testing.assert_array_equal(evaluate(kept.draws.copy()), kept.speeds)
        assert hand_written_skid.simulate(5_000, 1, 2_048, kernel).draws is None
