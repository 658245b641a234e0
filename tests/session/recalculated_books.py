"""The books that LibreOffice recalculates: each formula in one edition, and the case study.

The editions of a template give the same crash in each other's units (`tests/templates/test_editions.py`), and an
example has the formulas of its template. So LibreOffice is asked about one edition of each, of one units and the other
in turn; xlmc, which agrees with it there, answers for every book (`tests/templates/test_books.py`).
"""

from __future__ import annotations

from typing import Final

from committed_books import TEMPLATES

__all__ = ["RECALCULATED"]

_BOTH: Final = [name for name in TEMPLATES if not name.endswith("-si")]

RECALCULATED: Final = (
    "intersection",
    "intersection-momentum",
    *(f"{name}-si" if turn % 2 and f"{name}-si" in TEMPLATES else name for turn, name in enumerate(_BOTH)),
)
"""Names of committed books."""
