import numpy as np
import pytest

from xlmc.analysis.studies.sensitivity.first_look import LOOK_TRIALS, first_look

MOST = 20
OTHERS = 400

SHAPES = {
    "square": lambda x, z: (2.0 * x - 1.0) ** 2,
    "sine": lambda x, z: np.sin(2.0 * np.pi * 3.0 * x),
    "step at 99 %": lambda x, z: (x > 0.99).astype(float),
    "interaction": lambda x, z: (2.0 * x - 1.0) * (2.0 * z - 1.0),
    "widening": lambda x, z: x * (z - 0.5),
    "heavy tail": lambda x, z: np.exp(3.0 * x) / (1.0 - z),
    "yes or no": lambda x, z: (x + z > 1.8).astype(float),
    "line": lambda x, z: x,
}


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("seed", range(3))
def test_the_look_finds_every_shape_among_many(shape, seed):
    """The one that counts is the last of 402."""
    random = np.random.default_rng(seed)
    draws = random.random((OTHERS + 2, LOOK_TRIALS))
    clean = SHAPES[shape](draws[-1], draws[-2])
    y = clean + 0.02 * np.ptp(np.quantile(clean, (0.05, 0.95))) * random.standard_normal(LOOK_TRIALS)
    assert OTHERS + 1 in first_look(list(draws), [y]).first(0, MOST)


def test_squared_correlations_are_those_of_the_ranks():
    from scipy.stats import spearmanr

    random = np.random.default_rng(7)
    draws = random.random((3, 500))
    draws[1] = np.round(draws[1] * 4)  # equal values
    forecasts = [draws[0] + draws[1], np.exp(5 * draws[2])]
    result = first_look(list(draws), forecasts).squares
    expected = [[spearmanr(x, y).statistic ** 2 for y in forecasts] for x in draws]
    np.testing.assert_allclose(result, expected, rtol=1e-12)


def test_bits_depend_on_nothing_else():
    """Neither on the other assumptions and forecasts nor on their number."""
    random = np.random.default_rng(8)
    draws, forecasts = random.random((130, LOOK_TRIALS)), random.standard_normal((5, LOOK_TRIALS))
    whole = first_look(list(draws), list(forecasts))
    alone = first_look([draws[100]], [forecasts[3]])
    assert whole.scores[100, 3] == alone.scores[0, 0]
    assert whole.squares[100, 3] == alone.squares[0, 0]


def test_what_does_not_vary_has_no_score():
    random = np.random.default_rng(9)
    draws = [random.random(100), np.full(100, 3.0)]
    result = first_look(draws, [random.random(100), np.full(100, 2.0), np.full(100, np.nan)])
    assert np.isfinite(result.scores[0, 0])
    assert np.isneginf(result.scores[[1, 0, 0], [0, 1, 2]]).all()
    assert not result.squares[[1, 0, 0], [0, 1, 2]].any()
