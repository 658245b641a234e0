"""Numbers and texts written in a format."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from xlmc.excel.functions.number_format import FormatError, parse_format

REFUSED = "refused"


def _written(code: str, value: float | str, date1904: bool = False) -> str:
    try:
        form = parse_format(code)
        return form.text(value) if isinstance(value, str) else form.number(float(value), date1904)
    except FormatError:
        return REFUSED


@pytest.fixture(scope="session")
def written() -> Callable[..., str]:
    """`written("0.00", 12.345)`; "refused" where Excel has no such format or shows no such number."""
    return _written
