"""Functions whose cells show results of a run: `CB.GetForeStatFN(B9, 2)`, `RiskPercentile(B9, 0.95)`.

Source: Oracle Crystal Ball Developer's Guide, "Crystal Ball functions"; @RISK's manual, "Statistics Functions".
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Final

from xlmc.address import Area, Cell
from xlmc.definitions.in_cells.call_arguments import is_left_out
from xlmc.definitions.in_cells.crystal_ball_functions import CRYSTAL_BALL
from xlmc.definitions.in_cells.risk_functions import RISK
from xlmc.definitions.in_cells.risk_properties import is_property, is_property_name
from xlmc.errors import FormulaError
from xlmc.formula import ir

__all__ = [
    "CRYSTAL_BALL_STATISTICS",
    "NOT_COMPUTED",
    "RESULTS",
    "ResultCall",
    "is_result",
    "mentions_result",
    "not_computed",
    "result_call",
]

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
    "RiskPtoXD": ("share from above", 2),
    "RiskQtoX": ("share from above", 2),
    "RiskTarget": ("certainty", 2),
    "RiskXtoP": ("certainty", 2),
    "RiskTargetD": ("certainty from above", 2),
    "RiskXtoPD": ("certainty from above", 2),
    "RiskXtoQ": ("certainty from above", 2),
    "RiskData": ("trial", 2),
}
"""Function -> what it shows, and how many arguments it has: the cell, and a number for some."""

_THEORETICAL: Final = (
    "CoeffOfVariation",
    "Kurtosis",
    "Max",
    "Mean",
    "MeanAbsDev",
    "Min",
    "Mode",
    "Percentile",
    "PercentileD",
    "PtoX",
    "PtoXD",
    "QtoX",
    "Range",
    "SemiStdDev",
    "SemiVariance",
    "Skewness",
    "StdDev",
    "Target",
    "TargetD",
    "Variance",
    "XtoP",
    "XtoPD",
    "XtoQ",
    "XtoY",
)

NOT_COMPUTED: Final = (
    "CB.CheckDataFN",
    "CB.GetAssumFN",
    "CB.GetAssumPercentFN",
    "CB.GetAssumStatFN",
    "CB.GetCorrelationFN",
    "CB.GetDecVarFN",
    "CB.GetForeFN",
    "CB.GetRunPrefsFN",
    "CB.IterationsFN",
    "RiskCIMean",
    "RiskConvergenceLevel",
    "RiskCorrel",
    "RiskCp",
    "RiskCpk",
    "RiskCpkLower",
    "RiskCpkUpper",
    "RiskCpm",
    "RiskCurrentIter",
    "RiskCurrentSim",
    "RiskDPM",
    "RiskK",
    "RiskLowerXBound",
    "RiskMeanAbsDev",
    "RiskPNC",
    "RiskPNCLower",
    "RiskPNCUpper",
    "RiskPPMLower",
    "RiskPPMUpper",
    "RiskResultsGraph",
    "RiskSemiStdDev",
    "RiskSemiVariance",
    "RiskSensitivity",
    "RiskSensitivityStatChange",
    "RiskSigmaLevel",
    "RiskSimulationInfo",
    "RiskStopRun",
    "RiskUpperXBound",
    "RiskYV",
    "RiskZLower",
    "RiskZMin",
    "RiskZUpper",
    *(f"RiskTheo{what}" for what in _THEORETICAL),
)
"""Functions that show results, and that xlmc does not compute."""

_OTHER_DRAWS: Final = "Compound Library MakeInput Resample Simtable Splice Vary"
"""@RISK's functions that draw, or stand for a value as a draw does, and that xlmc does not know."""

_BY_NAME: Final = {name.upper(): (name, *row) for name, row in RESULTS.items()}
_WRITTEN: Final = {name.upper(): name for name in (*NOT_COMPUTED, *RESULTS)}
_DRAWS: Final = frozenset(
    ["RISKOUTPUT", *map(str.upper, (*RISK, *CRYSTAL_BALL)), *(f"RISK{name.upper()}" for name in _OTHER_DRAWS.split())]
)
_CALLED: Final = re.compile(r"(?<![\w.])(?:_xl\w+\.)*(Risk\w+|CB\.\w+)\s*\(", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class ResultCall:
    """What a call shows: of which cell (or of which forecast, by name), what, and the number it takes, if any."""

    function: str
    of: Cell | str
    what: str
    number: ir.Expression | None


def is_result(tree: ir.Expression) -> bool:
    """Whether a part of a formula shows a result that xlmc computes."""
    return isinstance(tree, ir.Call) and tree.name in _BY_NAME


def not_computed(tree: ir.Expression) -> str | None:
    """The name of a function of @RISK or Crystal Ball that shows a result xlmc does not compute; None for any other.

    A function with their prefix that nobody knows may show a result, and is taken for one that does.
    """
    if not isinstance(tree, ir.Call) or is_result(tree) or is_property(tree) or not _shows(tree.name):
        return None
    return _WRITTEN.get(tree.name, tree.name)


def _shows(name: str) -> bool:
    """Whether a function may show a result, by its name in capitals."""
    if not name.startswith(("RISK", "CB.")) or name in _DRAWS or is_property_name(name):
        return False
    return not (name.startswith("RISKTS") or name.endswith(("ALT", "ALTD")))


def mentions_result(text: str) -> bool:
    """Whether a formula that cannot be read calls a function that may show a result."""
    return any(_shows(name.upper()) for name in _CALLED.findall(text))


def result_call(call: ir.Call) -> ResultCall:
    """What a call shows.

    Raises:
        FormulaError: its arguments are not what they must be, or ask for another simulation than the first or for a
            part of its values.
    """
    function, what, count = _BY_NAME[call.name]
    if len(call.arguments) < count:
        takes = "the cell of an output" if count == 1 else "the cell of an output, and a number"
        raise FormulaError(f"{function} has {len(call.arguments)} arguments", hint=f"it takes {takes}")
    _refuse_more(function, call.arguments[count:])
    of = call.arguments[0]
    if isinstance(of, Area) and of.rows == of.columns == 1:
        of = Cell(of.sheet, of.top, of.left)
    if not isinstance(of, Cell | ir.Text):
        raise FormulaError(f"{function} must name the cell of an output first", hint="such as RiskMean(B9)")
    named = of.value if isinstance(of, ir.Text) else of
    return ResultCall(function, named, what, call.arguments[1] if count == 2 else None)


def _refuse_more(function: str, more: tuple[ir.Expression, ...]) -> None:
    """@RISK takes the number of a simulation, of which xlmc runs one, and properties that leave out values."""
    for index, argument in enumerate(more):
        if isinstance(argument, ir.Call) and is_property(argument):
            hint = "leave it out: xlmc shows results of all accepted trials"
            raise FormulaError(f"{function} of a part of the values is not computed", hint=hint)
        if index or function.startswith("CB."):
            raise FormulaError(f"{function} has {len(more) - index} arguments too many", hint="take them out")
        if not (is_left_out(argument) or argument == ir.Number(1.0)):
            hint = "leave the number of the simulation out, or write 1: xlmc runs one simulation"
            raise FormulaError(f"{function} asks for another simulation than the first", hint=hint)
