from __future__ import annotations

import pytest

from xlmc.excel.iteration import Iteration
from xlmc.excel.workbook.structure import iteration_of

USUAL = Iteration(100, 0.001)


@pytest.mark.parametrize(
    ("settings", "result"),
    [
        ({}, None),
        ({"iterate": "0", "iterateCount": "5"}, None),
        ({"iterate": "1"}, USUAL),
        ({"iterate": "true", "iterateCount": "20", "iterateDelta": "1E-4"}, Iteration(20, 1e-4)),
        ({"iterate": "1", "iterateCount": "1"}, Iteration(1, 0.001)),
        ({"iterate": "1", "iterateCount": "32767"}, Iteration(32_767, 0.001)),
        ({"iterate": "1", "iterateCount": "32768"}, USUAL),
        ({"iterate": "1", "iterateCount": "0"}, USUAL),
        ({"iterate": "1", "iterateCount": "many"}, USUAL),
        ({"iterate": "1", "iterateDelta": "0"}, Iteration(100, 0.0)),
        ({"iterate": "1", "iterateDelta": "5"}, Iteration(100, 5.0)),
        ({"iterate": "1", "iterateDelta": "-1e-9"}, USUAL),
        ({"iterate": "1", "iterateDelta": "inf"}, USUAL),
        ({"iterate": "1", "iterateDelta": "nan"}, USUAL),
        ({"iterate": "1", "iterateDelta": "little"}, USUAL),
    ],
)
def test_how_circles_are_computed(settings, result):
    assert iteration_of(settings) == result
