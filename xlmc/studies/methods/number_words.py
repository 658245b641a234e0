"""Numbers as they stand in sentences about methods."""

from __future__ import annotations

import numpy as np

from xlmc.studies.methods.answer import STATISTICS

__all__ = ["percent_words", "rounded_text", "seconds_text", "statistic_words", "trials_text"]


def statistic_words(statistic: str) -> str:
    """As it stands in a sentence: `lower end`, `SD`."""
    name = STATISTICS[statistic]
    return name if name.isupper() else name.lower()


def percent_words(share: float) -> str:
    """`1.8 %`: three significant digits.

    >>> percent_words(0.0175)
    '1.75 %'
    """
    return f"{100.0 * share:.3g} %" if abs(share) < 10.0 else f"{100.0 * share:,.0f} %"


def rounded_text(value: float) -> str:
    """Two significant digits."""
    return f"{float(f'{value:.2g}'):g}" if 0.001 <= abs(value) < 1e4 or value == 0.0 else f"{value:.1e}"


def trials_text(trials: float) -> str:
    """`1,200,000`: two significant digits.

    >>> trials_text(1_234_567.0)
    '1,200,000'
    """
    if not np.isfinite(trials):
        return "infinitely many"
    size = 10 ** max(len(f"{trials:.0f}") - 2, 0)
    return f"{round(trials / size) * size:,}"


def seconds_text(seconds: float) -> str:
    """`0.35 s`, `12 s`, `4 min`, `3 h`; a dash where no run came to an end.

    >>> seconds_text(0.0123), seconds_text(250.0), seconds_text(9_000.0)
    ('0.012 s', '4.2 min', '2.5 h')
    """
    if not np.isfinite(seconds):
        return "–"
    for length, name, top in ((1.0, "s", 120.0), (60.0, "min", 7_200.0), (3_600.0, "h", 172_800.0)):
        if seconds < top:
            return f"{float(f'{seconds / length:.2g}'):g} {name}"
    return f"{float(f'{seconds / 86_400.0:.2g}'):,g} days"
