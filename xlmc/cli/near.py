"""The name that a person may have meant."""

from __future__ import annotations

from collections.abc import Iterable

__all__ = ["did_you_mean"]


def did_you_mean(typed: str, known: Iterable[str]) -> str:
    """A question to put behind a message, with a blank before it; empty where no known name is alike.

    >>> did_you_mean("planar-imapct", ["skid", "planar-impact"])
    ' Did you mean planar-impact?'
    """
    from difflib import get_close_matches

    spellings = {name.casefold(): name for name in known}
    found = get_close_matches(typed.casefold(), spellings, n=1, cutoff=0.6)
    return f" Did you mean {spellings[found[0]]}?" if found else ""
