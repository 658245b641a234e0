"""Whether mean and standard deviation hang on a single trial.

Of a forecast with a variance, the part that the farthest trial has in it goes to 0 as trials are added: 1,000 trials
of a normal forecast give it about 1 %, of an exponential one 4 %. Of a forecast without one it never does: of a ratio
whose denominator passes 0 (Cauchy) it is 25 to 100 %, however many trials there are. The mean of such a forecast does
not exist; the number printed for it is an accident of the seed, and so is its error.
"""

from __future__ import annotations

import math

from numpy.typing import ArrayLike

from xlmc.statistics.sample import Sample, Values

__all__ = ["farthest_part"]


def farthest_part(values: Values, weights: ArrayLike | None = None, replicate: ArrayLike | None = None) -> float:
    """The part that the trial farthest from the mean has in the sum of squares about it; nan where nothing varies.

    >>> round(farthest_part([0.0, 0.0, 0.0, 4.0]), 12)
    0.75
    """
    sample = Sample.of(values, weights, replicate)
    m = sample.moments
    if sample.n == 0 or not m.scale > 0.0:
        return math.nan
    shares = (1.0 / sample.n,) * 2 if sample.w is None else (float(sample.w[0]), float(sample.w[-1]))
    ends = float(sample.x[0]), float(sample.x[-1])
    return max(share * ((end - m.mean) / m.scale) ** 2 for share, end in zip(shares, ends, strict=True))
