from __future__ import annotations

from decimal import Decimal, getcontext

import numpy as np
import pytest

from xlmc.montecarlo.model.loading import load

getcontext().prec = 60
PI = Decimal("3.14159265358979323846264338327950288419716939937510582097494459")
FORECASTS = ("Vehicle 1 delta-V", "Vehicle 2 delta-V", "Vehicle 1 impact speed", "Vehicle 2 impact speed")


@pytest.mark.parametrize("units", ["", "-si"])
def test_every_trial_gives_what_planar_impact_gives(book_path, units):
    """The same draws by name, before filters: equal to 1e-12 of the width of the central 51 % range."""
    trials = 20_000
    simple, full = (load(book_path[name + units]) for name in ("momentum", "planar-impact"))
    rng = np.random.default_rng(5)
    draws = {a.name: rng.uniform(a.parameters["low"], a.parameters["high"], trials) for a in full.live}
    needed = {a.name for a in simple.live}
    assert needed < set(draws)
    ours = simple.function({name: values for name, values in draws.items() if name in needed})
    theirs = full.function(draws)
    for name in FORECASTS:
        low, high = np.quantile(theirs[name], [0.245, 0.755])
        assert np.abs(ours[name] - theirs[name]).max() <= 1e-12 * (high - low), name


def sine(degrees: Decimal) -> Decimal:
    x = (degrees % 360) * PI / 180
    total, term, k = Decimal(0), x, 1
    while abs(term) > Decimal(10) ** -58:
        total += term
        term *= -x * x / ((k + 1) * (k + 2))
        k += 2
    return total


def exact_speed_2(scene):
    """Equation (16) with (15) put into it, to 50 digits, without the pole: V2i, and the size of its two terms."""
    v = {symbol: Decimal(float(value)) for symbol, value in scene.items()}
    speed = {j: (2 * v["g"] * v[f"f_{j}"] * v[f"s_{j}"]).sqrt() for j in (1, 2)}
    delta = sine(v["alpha_1"] - v["alpha_2"])
    terms = [-v[f"w_{j}"] / v["w_2"] * speed[j] * sine(v[f"beta_{j}"] - v["alpha_1"]) / delta for j in (1, 2)]
    return sum(terms), sum(map(abs, terms))


# Stress -> the relative error of V2i that the rewritten equation is known to have there.
STRESSES = [
    ("delta", 1.0, 9e-16),
    ("delta", 0.01, 1e-13),
    ("alpha_2", 272.0, 4e-16),
    ("alpha_2", 90.0, 4e-16),
    ("alpha_2", 270.0, 4e-16),
]


@pytest.mark.parametrize("name", ["momentum", "planar-impact"])
@pytest.mark.parametrize(("what", "value", "error"), STRESSES)
def test_speed_of_vehicle_2_keeps_its_digits(name, what, value, error, cells, described):
    """300 scenes of the example's ranges against 50 digits: the median error as known; the largest, relative to the
    terms that V2i is the difference of, within 8 times that.
    """
    rng, n = np.random.default_rng(3), 300
    ranges = {given.symbol: given.parameters for given in described["momentum"].assumptions}
    scene = {symbol: rng.uniform(p["Low"], p["High"], n) for symbol, p in ranges.items()}
    scene["g"] = np.full(n, 32.174)
    if what == "delta":
        scene["alpha_1"] = scene["alpha_2"] + value
    else:
        turn = value - scene["alpha_2"]
        scene |= {symbol: scene[symbol] + turn for symbol in ("alpha_1", "beta_1", "beta_2")}
        scene["alpha_2"] = np.full(n, value)
    result = cells(name, scene, ["V2_i"])["V2_i"]
    exact = [exact_speed_2({symbol: values[i] for symbol, values in scene.items()}) for i in range(n)]
    off = [abs(Decimal(float(x)) - truth) for x, (truth, _) in zip(result, exact, strict=True)]
    assert np.median([float(d / abs(truth)) for d, (truth, _) in zip(off, exact, strict=True)]) <= error
    assert max(float(d / terms) for d, (_, terms) in zip(off, exact, strict=True)) <= 8 * error
