from __future__ import annotations

import pytest
from fewer_sheets import SENSITIVITY, leave_out


@pytest.fixture(scope="module", autouse=True)
def _short_books():
    """The sheets on sensitivity take longest to write, and no test here looks at them."""
    with pytest.MonkeyPatch.context() as patch:
        leave_out(patch, *SENSITIVITY)
        yield
