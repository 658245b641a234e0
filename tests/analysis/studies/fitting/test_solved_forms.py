from __future__ import annotations

import math

import numpy as np
import pytest

from xlmc.analysis.studies.fitting import Unfit
from xlmc.analysis.studies.fitting.solved_forms import maximise, root


def test_the_top_of_a_hill():
    result = maximise(lambda p: -((p[0] - 3) ** 2) - 5 * (p[1] + 2 - p[0]) ** 2, [0.0, 0.0])
    np.testing.assert_allclose(result, [3, 1], atol=1e-5)


def test_a_hill_without_a_top():
    with pytest.raises(Unfit, match="no highest point"):
        maximise(lambda p: math.nan, [0.0])


@pytest.mark.parametrize("answer", [1e-4, 0.7, 3e4])
def test_a_root_outside_the_bracket(answer):
    assert root(lambda x: math.log(x / answer), 0.1, 10) == pytest.approx(answer, rel=1e-12)


@pytest.mark.parametrize("value", [-1.0, 1.0])
def test_no_root(value):
    with pytest.raises(Unfit, match="no highest point"):
        root(lambda _: value, 0.1, 10)
