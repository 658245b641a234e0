"""What the empty cells at the end of a whole column are to Excel's functions: by their names."""

from __future__ import annotations

from functools import cache, partial
from typing import Final

import numpy as np

from xlmc.errors import FormulaError
from xlmc.functions import Function, Kind
from xlmc.functions.budget import TooLargeError
from xlmc.functions.registry import Number
from xlmc.functions.values import Floats

__all__ = ["FIRST_ONLY", "IGNORING", "LASTING", "ON_NUMBERS", "PAIRING", "SUMMING", "at_the_last", "kept", "refused"]


def _names(text: str) -> frozenset[str]:
    return frozenset(text.split())


IGNORING: Final = _names(
    "AVEDEV AVERAGE AVERAGEA AVERAGEIF CONCAT COUNT COUNTA DEVSQ FVSCHEDULE GEOMEAN HARMEAN IRR KURT LARGE MAX MAXA "
    "MEDIAN MIN MINA MIRR MODE MODE.MULT MODE.SNGL NPV PERCENTILE PERCENTILE.EXC PERCENTILE.INC PERCENTRANK "
    "PERCENTRANK.EXC PERCENTRANK.INC PRODUCT QUARTILE QUARTILE.EXC QUARTILE.INC RANK RANK.AVG RANK.EQ SKEW SKEW.P "
    "SMALL STDEV STDEV.P STDEV.S STDEVA STDEVP STDEVPA SUM SUMIF SUMSQ TRIMMEAN VAR VAR.P VAR.S VARA VARP VARPA "
    "AND OR XOR Z.TEST ZTEST NETWORKDAYS NETWORKDAYS.INTL WORKDAY WORKDAY.INTL"
)
"""Functions to which empty cells of a range are nothing."""

FIRST_ONLY: Final = _names("DAVERAGE DCOUNT DCOUNTA DMAX DMIN DPRODUCT DSTDEV DSTDEVP DSUM DVAR DVARP FREQUENCY")
"""Functions to which empty cells of their first range are nothing."""

PAIRING: Final = _names(
    "SUMPRODUCT CORREL PEARSON RSQ COVARIANCE.P COVARIANCE.S COVAR SLOPE INTERCEPT STEYX FORECAST FORECAST.LINEAR "
    "SUMX2MY2 SUMX2PY2 SUMXMY2 T.TEST TTEST F.TEST FTEST SUMIFS AVERAGEIFS MAXIFS MINIFS"
)
"""Functions that take ranges of one size, to which empty cells in all of them are nothing."""

SUMMING: Final = _names("SUM SUMSQ COUNT COUNTA")
"""Functions of more cells that give the sum of what they give of each part."""

LASTING: Final = _names("MAX MIN MAXA MINA AND OR")
"""Functions to which it is the same how often a cell is repeated."""

ON_NUMBERS: Final = _names(
    "AVERAGE AVEDEV DEVSQ GEOMEAN HARMEAN KURT LARGE MEDIAN PERCENTILE PERCENTILE.EXC PERCENTILE.INC PRODUCT QUARTILE "
    "QUARTILE.EXC QUARTILE.INC SKEW SMALL STDEV STDEV.P STDEV.S STDEVP VAR VAR.P VAR.S VARP"
)
"""Functions of the numbers in an array, to which its texts and logicals are nothing."""

_MESSAGE: Final = (
    "{} is given a whole column or row, or a range that goes on far beyond the last filled cell; xlmc cannot take all "
    "its empty cells there"
)
_HINT: Final = "name only the rows and columns that hold something"


def refused(name: str) -> FormulaError:
    """What a person is told of a function that cannot be given a whole column."""
    return FormulaError(_MESSAGE.format(name), hint=_HINT)


@cache
def kept(held: int, whole: int, zero_is_all: bool) -> Function:
    """Numbers of rows or columns beyond the `held` ones, as that of the last of them, if they are of the `whole`."""
    body = partial(_within, held=held, whole=whole, zero_is_all=zero_is_all)
    return Function(f"within {held} of {whole}", (Number,), body, Kind.NUMBER)


@cache
def at_the_last(held: int, whole: int) -> Function:
    """Numbers of rows or columns beyond the `held` ones, as that of the last of the `whole`."""
    return Function(f"{held} or {whole}", (Number,), partial(_of_whole, held=held, whole=whole), Kind.NUMBER)


def _of_whole(numbers: Floats, held: int, whole: int) -> Floats:
    return np.where(numbers > held, float(whole), numbers)


def _within(numbers: Floats, held: int, whole: int, zero_is_all: bool) -> Floats:
    if zero_is_all and (np.trunc(numbers) == 0).any():
        raise TooLargeError(_MESSAGE.format("INDEX with row or column 0"), hint=_HINT)
    return np.where(numbers < whole + 1, np.minimum(numbers, held), numbers)
