from __future__ import annotations

import pytest


@pytest.fixture(scope="module", autouse=True)
def _short_books():
    """The sheets on sensitivity take longest to write, and no test here looks at them."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("xlmc.report.sheets.book.write_dependence", lambda *_: None)
        yield
