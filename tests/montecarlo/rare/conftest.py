from __future__ import annotations

import numpy as np
import pytest

from xlmc.montecarlo.rare import learning


@pytest.fixture
def random():
    return np.random.default_rng(11)


@pytest.fixture(scope="module", autouse=True)
def small_populations():
    """An eighth of the points and trials that a search learns from; whatever it learned, its answers must be right."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(learning, "_POPULATION", 512)
        patch.setattr(learning, "_FIRST", 8_192)
        patch.setattr(learning, "_FITTED", 2_048)
        patch.setattr(learning, "_TRIALS", 4_096)
        yield
