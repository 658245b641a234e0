"""Lists, verbs and durations in words, as messages need them."""

from __future__ import annotations

from collections.abc import Sequence

from xlmc.montecarlo.number_text import number_text

__all__ = ["be", "duration", "list_of"]


def list_of(words: Sequence[str]) -> str:
    """Join words with commas and "and".

    >>> list_of(["mean"]), list_of(["mean", "sd", "range"])
    ('mean', 'mean, sd and range')
    """
    if len(words) == 1:
        return words[0]
    return f"{', '.join(words[:-1])} and {words[-1]}"


def be(things: int) -> str:
    """Return `was` for one thing, `were` for several."""
    return "was" if things == 1 else "were"


def duration(seconds: float) -> str:
    """Say a duration in the largest units in which it is whole.

    >>> duration(60), duration(5400), duration(0.5), duration(3661)
    ('1 min', '1 h 30 min', '0.5 s', '1 h 1 min 1 s')
    """
    minutes, rest = divmod(seconds, 60)
    hours, minutes = divmod(int(minutes), 60)
    parts = [f"{hours} h" * (hours > 0), f"{minutes} min" * (minutes > 0), f"{number_text(rest)} s" * (rest > 0)]
    return " ".join(part for part in parts if part)
