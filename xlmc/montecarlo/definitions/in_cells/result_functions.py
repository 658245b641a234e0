"""Functions whose cells show results of a run: `CB.GetForeStatFN(B9, 2)`, `RiskPercentile(B9, 0.95)`.

Source: Oracle Crystal Ball Developer's Guide, "Crystal Ball functions"; @RISK's manual, "Statistics Functions".
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Final

from xlmc.errors import FormulaError
from xlmc.excel.address import Area, Cell
from xlmc.excel.formula import ir
from xlmc.montecarlo.definitions.in_cells.call_arguments import is_left_out
from xlmc.montecarlo.definitions.in_cells.crystal_ball_functions import CRYSTAL_BALL
from xlmc.montecarlo.definitions.in_cells.risk_functions import RISK, TRUNCATED
from xlmc.montecarlo.definitions.in_cells.risk_properties import is_property, is_property_name
from xlmc.montecarlo.definitions.in_cells.theory import THEORETICAL

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
    "RiskMeanAbsDev": ("mean_absolute_deviation", 1),
    "RiskCIMean": ("confidence", 2),
    "RiskCorrel": ("correlation", 3),
    "CB.GetAssumFN": ("assumption", 2),
    "CB.GetAssumPercentFN": ("percent of the assumption", 2),
    "CB.GetRunPrefsFN": ("preference", 1),
    "CB.IterationsFN": ("trials run", 0),
}
"""Function -> what it shows, and how many arguments it has: the cell, and a number for some.

`RiskCIMean` takes TRUE or FALSE, too: the lower end of the interval, or the upper one.
"""

_OF_NO_CELL: Final = ("CB.GetRunPrefsFN", "CB.IterationsFN")

NOT_COMPUTED: Final = (
    "CB.CheckDataFN",
    "CB.GetAssumStatFN",
    "CB.GetCorrelationFN",
    "CB.GetDecVarFN",
    "CB.GetForeFN",
    "RiskConvergenceLevel",
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
    "RiskTheoMode",
    "RiskTheoSemiStdDev",
    "RiskTheoSemiVariance",
    "RiskTheoXtoY",
)
"""Functions that show results, and that xlmc does not compute."""

_OTHER_DRAWS: Final = "Compound CorrectCorrmat IsValidCorrmat Library MakeInput Resample Simtable Splice Vary"
"""@RISK's functions that draw, or stand for a value as a draw does: none shows a result."""

_BY_NAME: Final = {name.upper(): (name, *row) for name, row in RESULTS.items()}
_WRITTEN: Final = {name.upper(): name for name in (*NOT_COMPUTED, *RESULTS)}
_DRAWS: Final = frozenset(
    [
        "RISKOUTPUT",
        *map(str.upper, (*RISK, *CRYSTAL_BALL)),
        *TRUNCATED,
        *(f"RISK{name.upper()}" for name in _OTHER_DRAWS.split()),
    ]
)
_THEORY: Final = frozenset(map(str.upper, THEORETICAL))
_CALLED: Final = re.compile(r"(?<![\w.])(?:_xl\w+\.)*(Risk\w+|CB\.\w+)\s*\(", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class Limits:
    """The part of the values that a call asks about: from one number to another, or between two probabilities."""

    lower: ir.Expression | None
    upper: ir.Expression | None
    percents: bool


@dataclass(frozen=True, slots=True)
class ResultCall:
    """What a call shows.

    Attributes:
        of: of which cell, or of which forecast by name; None if it is about the run.
        number: that it takes, if any.
        other: the second cell of a correlation.
        upper: it asks for the upper end of an interval.
        limits: it is about a part of the values.
        simulation: the number of the simulation, from 1; None for the first.
    """

    function: str
    of: Cell | str | None
    what: str
    number: ir.Expression | None
    other: Cell | str | None = None
    upper: bool = False
    limits: Limits | None = None
    simulation: ir.Expression | None = None

    @property
    def arguments(self) -> tuple[ir.Expression, ...]:
        """The trees whose numbers it needs."""
        ends = () if self.limits is None else (self.limits.lower, self.limits.upper)
        return tuple(each for each in (self.number, *ends, self.simulation) if each is not None)

    @property
    def forecasts(self) -> tuple[Cell | str, ...]:
        """The cells, or names of forecasts, whose values it needs."""
        if self.what in ("assumption", "percent of the assumption"):
            return ()
        return tuple(each for each in (self.of, self.other) if each is not None)


def is_result(tree: ir.Expression) -> bool:
    """Whether a part of a formula shows a result that xlmc computes."""
    return isinstance(tree, ir.Call) and tree.name in _BY_NAME


def not_computed(tree: ir.Expression) -> str | None:
    """Return the name of a function of @RISK or Crystal Ball that shows a result xlmc does not compute; None for any
    other.

    A function with their prefix that nobody knows may show a result, and is taken for one that does.
    """
    if not isinstance(tree, ir.Call) or is_result(tree) or is_property(tree) or not _shows(tree.name):
        return None
    return _WRITTEN.get(tree.name, tree.name)


def _shows(name: str) -> bool:
    """Whether a function may show a result, by its name in capitals."""
    if not name.startswith(("RISK", "CB.")) or name in _DRAWS or name in _THEORY or is_property_name(name):
        return False
    return not (name.startswith("RISKTS") or name.endswith(("ALT", "ALTD")))


def mentions_result(text: str) -> bool:
    """Whether a formula that cannot be read calls a function that may show a result."""
    return any(_shows(name.upper()) for name in _CALLED.findall(text))


def result_call(call: ir.Call) -> ResultCall:
    """Return what a call shows.

    Raises:
        FormulaError: its arguments are not what they must be.
    """
    function, what, count = _BY_NAME[call.name]
    arguments = tuple(argument for argument in call.arguments if not is_property(argument))
    limits = _limits(function, [argument for argument in call.arguments if is_property(argument)])
    if len(arguments) < count:
        raise FormulaError(f"{function} has {len(arguments)} arguments", hint=f"it takes {_TAKES[min(count, 3)]}")
    more = arguments[count:]
    upper = False
    if function == "RiskCIMean" and more and isinstance(more[0], ir.Logical | ir.Missing):
        upper, more = isinstance(more[0], ir.Logical) and not more[0].value, more[1:]
    simulation = _simulation(function, more)
    if function in _OF_NO_CELL:
        return ResultCall(function, None, what, arguments[0] if count else None)
    of = _cell_or_name(function, arguments[0])
    other = _cell_or_name(function, arguments[1]) if function == "RiskCorrel" else None
    if limits and (other is not None or what in ("trial", "confidence")):
        hint = "leave RiskTruncate out"
        raise FormulaError(f"{function} of a part of the values is not computed", hint=hint)
    number = arguments[count - 1] if count > 1 else None
    return ResultCall(function, of, what, number, other, upper, limits, simulation)


_TAKES: Final = ("nothing", "the cell of an output", "the cell of an output, and a number", "two cells, and a number")


def _cell_or_name(function: str, tree: ir.Expression) -> Cell | str:
    if isinstance(tree, Area) and tree.rows == tree.columns == 1:
        tree = Cell(tree.sheet, tree.top, tree.left)
    if not isinstance(tree, Cell | ir.Text):
        raise FormulaError(f"{function} must name the cell of an output first", hint="such as RiskMean(B9)")
    return tree.value if isinstance(tree, ir.Text) else tree


def _limits(function: str, given: list[ir.Expression]) -> Limits | None:
    """Return the part of the values that `RiskTruncate` or `RiskTruncateP` leaves."""
    if not given:
        return None
    call = given[0]
    if len(given) > 1 or not isinstance(call, ir.Call) or call.name not in ("RISKTRUNCATE", "RISKTRUNCATEP"):
        hint = "only RiskTruncate and RiskTruncateP say which part of the values a result is of"
        raise FormulaError(f"{function} has a property that it cannot have", hint=hint)
    ends = [None if is_left_out(end) else end for end in call.arguments[:2]]
    lower, upper = (*ends, None, None)[:2]
    return Limits(lower, upper, call.name == "RISKTRUNCATEP")


def _simulation(function: str, more: tuple[ir.Expression, ...]) -> ir.Expression | None:
    """@RISK takes the number of a simulation: the place of a value in every `RiskSimtable`."""
    if len(more) > 1 or (more and function.startswith("CB.")):
        few = len(more) if function.startswith("CB.") else len(more) - 1
        raise FormulaError(f"{function} has {few} arguments too many", hint="take them out")
    return more[0] if more and not is_left_out(more[0]) else None
