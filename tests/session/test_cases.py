from __future__ import annotations

import pytest
from cases import cases


@pytest.mark.parametrize("values", [[], [(1,)], [(1, 2), (1, 2, 3)]])
def test_cases_are_complete(values):
    with pytest.raises(ValueError, match="each case needs values for a, b"):
        cases("a, b", values)
