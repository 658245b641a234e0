"""A distribution, a sampling method, an engine and a result sheet that xlmc does not have, through their doors.

python tests/doors/made_up.py ARGUMENTS       as `xlmc ARGUMENTS`, with them
python tests/doors/made_up.py --undescribed   what no page describes
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

from xlmc import distributions
from xlmc.distributions.base import Family
from xlmc.distributions.parameters import HIGH, ParameterSpec
from xlmc.evaluation import engines
from xlmc.sampling import methods
from xlmc.sampling.streams import Stream


class EitherEnd(Family):
    """The least value or the highest, each with probability 1/2."""

    name = "Either End"
    parameters = (ParameterSpec("least", ("Least of all",)), HIGH)
    formula = "probability 1/2 at Least of all and at High"
    source = "made up"

    def _ppf(self, u, least, high):
        return np.where(u < 0.5, least, high)

    def _cdf(self, x, least, high):
        return np.where(x < least, 0.0, np.where(x < high, 0.5, 1.0))

    def _mean(self, least, high):
        return (least + high) / 2

    def _variance(self, least, high):
        return (high - least) ** 2 / 4

    def _support(self, least, high):
        return least, high


class Mirrored:
    """Pairs of trials of which the second is 1 - u of the first (antithetic variates, Hammersley and Morton 1956)."""

    def __init__(self, seed, name):
        self._stream = Stream(seed, name, "mirrored")

    def uniforms(self, start, out):
        pairs = np.empty((start + out.size + 1) // 2 - start // 2)
        self._stream.uniforms(start // 2, pairs)
        both = np.stack([pairs, 1.0 - 2.0**-53 - pairs], axis=1).ravel()
        out[:] = np.clip(both[start % 2 : start % 2 + out.size], 0.0, None)


def _margins(seed, dimensions, _size):
    return [Mirrored(seed, name) for name in dimensions]


def _write(page, run):
    page.title("Made up", run.name)
    page.sheet.write_number(page.row, 0, run.simulation.accepted)


def register() -> None:
    """Through each door: one row."""
    distributions.FAMILIES[EitherEnd.name] = EitherEnd()
    method = methods.SamplingMethod("mirrored", "mirrored pairs", "pairs of a stream", _margins, lambda _: 2)
    methods.METHODS[method.key] = method
    engines.ENGINES["slower"] = engines.ENGINES["numpy"]._replace(key="slower", what="as numpy")
    from xlmc.report.sheets import book

    book.SHEETS = (*book.SHEETS, book.ResultSheet("Made up", _write, after=("Trials",)))


if __name__ == "__main__":
    register()
    if sys.argv[1:] == ["--undescribed"]:
        sys.path.append(str(Path(__file__).resolve().parents[1] / "session"))
        from described import undescribed

        print("\n".join(undescribed()))
    else:
        from xlmc.cli import main

        main()
