"""What is said of trials that an error took."""

from __future__ import annotations

import pytest
from simulated import simulated

from xlmc.analysis.results.record.errors_met import lost_sentences


@pytest.mark.parametrize(("limit", "share"), [(0.996, "(100 %)"), (0.25, "(25 %)"), (0.002, "(0.2 %)")])
def test_a_share_is_written_without_a_power_of_ten(book, limit, share):
    cells = {"A1": 0.999, "B1": f"=IF(A1<{limit},1/0,A1)"}
    model = book(cells, {"a": {"cell": "A1", "low": 0, "high": 1}}, {"f": "B1"})
    message, *_ = lost_sentences(simulated(model, trials=100_000, seed=999))
    assert share in message
