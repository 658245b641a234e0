"""Calls of programs that xlmc does not read: Analytic Solver's `PsiNormal`, ModelRisk's `VoseNormal`.

They are named with their program and with the function to write instead. None is computed: nobody has proven what
their arguments mean.
"""

from __future__ import annotations

import re
from typing import Final

from xlmc.errors import FormulaError
from xlmc.montecarlo.definitions.in_cells.risk_functions import RISK

__all__ = ["PREFIXES", "of_another_program", "shows_its_result"]

PREFIXES: Final = {"PSI": "Analytic Solver (Risk Solver)", "VOSE": "ModelRisk"}
"""What the names of a program's functions begin with, in capitals -> the program."""

_MARKS: Final = ("OUTPUT",)
_RESULTS: Final = re.compile(
    "SIM|MEAN|MEDIAN|MODE|STDDEV|STDEV|VARIANCE|SKEWNESS|KURTOSIS|PERCENTILE|TARGET|MINIMUM|MAXIMUM|RANGE|CVAR|BVAR|"
    "EXPLOSS|EXPGAIN|SENSITIVITY|CORRELATION|CITRIALS|PTOX|XTOP|QTOX|XTOQ|DATA|ABSDEV|SEMIVAR|SEMIDEV|COUNT|FREQUENCY"
)
_LIKE: Final = {
    "TRIANGLE": "RiskTriang",
    "TRIANGULAR": "RiskTriang",
    "BETAGEN": "RiskBetaGeneral",
    "BETA4": "RiskBetaGeneral",
    "EXPONENTIAL": "RiskExpon",
    "NEGBINOMIAL": "RiskNegbin",
    "GEOMETRIC": "RiskGeomet",
    "HYPERGEO": "RiskHypergeo",
    "DISUNIFORM": "RiskDUniform",
    "HISTOGRAM": "RiskHistogrm",
    "CHISQUARE": "RiskChiSq",
    "LOGNORMAL": "RiskLognorm",
    "STUDENT": "RiskStudent",
    "MAXEXTREME": "RiskExtvalue",
    "MINEXTREME": "RiskExtvalueMin",
    "RELATIVE": "RiskGeneral",
    **{name.removeprefix("Risk").upper(): name for name in RISK},
}
"""What stands behind the prefix -> the function of the same family."""


def of_another_program(name: str) -> FormulaError | None:
    """Say what a function is, by its name in capitals; None if it is not known to belong to such a program."""
    prefix = next((each for each in PREFIXES if name.startswith(each)), None)
    rest = name.removeprefix(prefix or "")
    if prefix is None or not (prefix == "VOSE" or rest in _LIKE or rest in _MARKS or _RESULTS.match(rest)):
        return None  # a workbook's own code may have a function PsiAngle
    message = f"{name} is a function of {PREFIXES[prefix]}, which xlmc does not read"
    return FormulaError(message, hint=_instead(rest))


def _instead(rest: str) -> str:
    """Name the function to write instead of one that ends so."""
    if rest in _MARKS:
        return 'mark the answer by RiskOutput("its name")+ in front of its formula, or in a table xlmc_forecasts'
    if _is_result(rest):
        return "ask for the result by RiskMean, RiskStdDev, RiskPercentile or RiskTarget"
    like = _LIKE.get(rest)
    if like is None:
        return "write one of the functions in docs/workbooks.md, such as RiskNormal, or a row of xlmc_assumptions"
    return f"write {like}({', '.join(RISK[like].takes)}), or a row of xlmc_assumptions"


def shows_its_result(name: str) -> bool:
    """Whether a function of such a program, by its name in capitals, shows a result of the run."""
    return any(name.startswith(each) and _is_result(name.removeprefix(each)) for each in PREFIXES)


def _is_result(rest: str) -> bool:
    return _RESULTS.match(rest) is not None and rest not in _LIKE
