"""The order of texts, as Excel sorts them and as its approximate lookups compare them.

Case does not count. Symbols come before digits, digits before letters; a letter with an accent stands with its own.
Hyphens and apostrophes count only between texts that are otherwise equal.
"""

from __future__ import annotations

import unicodedata
from typing import Final

__all__ = ["order_key"]

_SYMBOLS: Final = '\t\n\r !"#$%&()*,./:;?@[\\]^_`{|}~+<=>'
_WEIGHTS: Final[dict[int, str | None]] = {
    **{ord(symbol): chr(place + 1) for place, symbol in enumerate(_SYMBOLS)},
    ord("-"): None,
    ord("'"): None,
}
"""All symbols weigh less than the digit 0."""


def order_key(text: str) -> tuple[str, str]:
    """What to sort a text by; two texts have one key where they differ in case at most."""
    folded = text.casefold()
    bare = folded if folded.isascii() else _without_accents(folded)
    return bare.translate(_WEIGHTS), folded


def _without_accents(text: str) -> str:
    return "".join(c for c in unicodedata.normalize("NFKD", text) if not unicodedata.combining(c))
