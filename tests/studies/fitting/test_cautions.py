from __future__ import annotations

import pytest

from xlmc.studies.fitting import cautions


@pytest.mark.parametrize(
    ("n", "words"),
    [(2, "2 values cannot tell"), (14, "cannot tell"), (15, "only roughly"), (29, "only roughly"), (30, None)],
)
def test_few_values(n, words):
    said = cautions(n, ["Normal"])
    if words is None:
        assert said == ()
    else:
        assert words in said[0]
        assert "uniform range" in said[0]


def test_rivals():
    (said,) = cautions(100, ["Normal", "Logistic", "Weibull"])
    assert said.startswith("Normal, Logistic and Weibull describe the values about equally well")
