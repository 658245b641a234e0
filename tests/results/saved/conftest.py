from __future__ import annotations

import pytest

from xlmc.report.sheets import book


@pytest.fixture(scope="module", autouse=True)
def _short_books():
    """The sheets on sensitivity take longest to write, and no test here looks at them."""
    with pytest.MonkeyPatch.context() as patch:
        slow = ("Sensitivity", "Filter limits")
        patch.setattr(book, "SHEETS", [sheet for sheet in book.SHEETS if sheet.name not in slow])
        yield
