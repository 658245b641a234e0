"""Functions whose cells show results of a run: `CB.GetForeStatFN(B9, 2)`, `RiskPercentile(B9, 0.95)`.

Source: Oracle Crystal Ball User's Guide, "Crystal Ball functions"; Palisade's @RISK manual, "Statistics Functions".
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from xlmc.address import Area, Cell
from xlmc.errors import FormulaError
from xlmc.formula import ir

__all__ = ["CRYSTAL_BALL_STATISTICS", "RESULTS", "Asked", "asked_for", "is_result"]

CRYSTAL_BALL_STATISTICS: Final = (
    "trials",
    "mean",
    "median",
    "mode",
    "standard_deviation",
    "variance",
    "skewness",
    "kurtosis",
    "coefficient_of_variation",
    "minimum",
    "maximum",
    "range_width",
    "mean_standard_error",
)
"""What the second argument of `CB.GetForeStatFN` counts, from 1."""

RESULTS: Final = {
    "CB.GetForeStatFN": ("statistic", 2),
    "CB.GetForePercentFN": ("percent", 2),
    "CB.GetCertaintyFN": ("certainty in percent", 2),
    "CB.GetForeDataFN": ("trial", 2),
    "RiskMean": ("mean", 1),
    "RiskMedian": ("median", 1),
    "RiskMode": ("mode", 1),
    "RiskStdDev": ("standard_deviation", 1),
    "RiskVariance": ("variance", 1),
    "RiskSkewness": ("skewness", 1),
    "RiskKurtosis": ("kurtosis", 1),
    "RiskCoeffOfVariation": ("coefficient_of_variation", 1),
    "RiskMin": ("minimum", 1),
    "RiskMax": ("maximum", 1),
    "RiskRange": ("range_width", 1),
    "RiskStdErrOfMean": ("mean_standard_error", 1),
    "RiskPercentile": ("share", 2),
    "RiskPtoX": ("share", 2),
    "RiskPercentileD": ("share from above", 2),
    "RiskQtoX": ("share from above", 2),
    "RiskTarget": ("certainty", 2),
    "RiskXtoP": ("certainty", 2),
    "RiskTargetD": ("certainty from above", 2),
    "RiskXtoQ": ("certainty from above", 2),
    "RiskData": ("trial", 2),
}
"""Function -> what it shows, and how many arguments it has: the cell, and a number for some."""

_BY_NAME: Final = {name.upper(): (name, *row) for name, row in RESULTS.items()}


@dataclass(frozen=True, slots=True)
class Asked:
    """What a call shows: of which cell (or of which forecast, by name), what, and the number it takes, if any."""

    function: str
    place: Cell | str
    what: str
    number: ir.Expression | None


def is_result(tree: ir.Expression) -> bool:
    """Whether a part of a formula shows a result."""
    return isinstance(tree, ir.Call) and tree.name in _BY_NAME


def asked_for(call: ir.Call) -> Asked:
    """What a call shows.

    Raises:
        FormulaError: its arguments are not what they must be.
    """
    function, what, count = _BY_NAME[call.name]
    if len(call.arguments) < count:
        takes = "the cell of an output" if count == 1 else "the cell of an output, and a number"
        raise FormulaError(f"{function} has {len(call.arguments)} arguments", hint=f"it takes {takes}")
    place = call.arguments[0]
    if isinstance(place, Area) and place.rows == place.columns == 1:
        place = Cell(place.sheet, place.top, place.left)
    if not isinstance(place, Cell | ir.Text):
        raise FormulaError(f"{function} must name the cell of an output first", hint="such as RiskMean(B9)")
    named = place.value if isinstance(place, ir.Text) else place
    return Asked(function, named, what, call.arguments[1] if count == 2 else None)
