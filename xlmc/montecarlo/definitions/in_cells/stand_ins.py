"""@RISK's functions that stand for a value without drawing one, and what is said of those that xlmc refuses.

| function | stands for |
|---|---|
| RiskMakeInput(formula) | the formula: what it draws is drawn as elsewhere |
| RiskSimtable({values}) | the first of the values; the others in scenarios of the run |

Source: @RISK's manual, "Simulation Functions" and "Miscellaneous Functions".
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Final

from xlmc.errors import FormulaError
from xlmc.excel.address import Cell
from xlmc.excel.formula import formula_text, ir
from xlmc.montecarlo.definitions.in_cells.call_arguments import elements, is_left_out
from xlmc.montecarlo.definitions.in_cells.risk_properties import is_property
from xlmc.montecarlo.definitions.problems import Findings
from xlmc.montecarlo.definitions.scenarios import Scenario, Tabulated

__all__ = ["REFUSED", "SIMTABLE", "STAND_INS", "simtable_scenarios", "stand_in", "unsupported"]

SIMTABLE: Final = "RISKSIMTABLE"
STAND_INS: Final = frozenset((SIMTABLE, "RISKMAKEINPUT"))

_SUPPORTED: Final = 'see "Functions in cells" in docs/workbooks.md for what is; replace the call by one of those'

REFUSED: Final = {
    "RiskSplice": "draw from both distributions, and choose between them by a third draw: IF(RAND()<p,…,…)",
    "RiskResample": "use RiskDUniform, which draws from the same values at random",
    "RiskVary": "write RiskTriang or RiskUniform around the value",
    "RiskCorrectCorrmat": "give RiskCorrmat the matrix as it was typed: xlmc brings it to the nearest possible one",
    "RiskIsValidCorrmat": "take it out: a notice says what is changed in a matrix that contradicts itself",
    "RiskLibrary": "write the distribution itself into the cell",
    "RiskTSAR1": "write the series into cells, each with RiskNormal and the cell before it",
    "RiskCurrentIter": "let no formula depend on the number of the trial: trials are independent",
    "RiskCurrentSim": "use RiskSimtable with the values themselves",
    "RiskStopRun": "end the run by a setting of xlmc_settings, such as Seconds or Precision",
    "RiskSensitivity": "look at the sheet Sensitivity of the result workbook",
    "RiskSensitivityStatChange": "look at the sheet Sensitivity of the result workbook",
    "RiskResultsGraph": "look at the sheet Charts of the result workbook, or at the page",
    "RiskSimulationInfo": "look at the sheet Record of the result workbook",
    "RiskConvergenceLevel": "look at the standard errors in the sheet Statistics, or set Precision in xlmc_settings",
    "RiskFitDistribution": "use xlmc fit, and write the distribution that it finds",
    "RiskFitParameter": "use xlmc fit, and write the numbers that it finds",
    "RiskFitStatistic": "use xlmc fit, which shows these numbers",
    "CB.GetDecVarFN": "name the decision's own cell",
    "CB.CheckDataFN": "take it out: xlmc check looks the workbook over",
}
"""Function -> what to use instead."""

_BY_NAME: Final = {name.upper(): (name, hint) for name, hint in REFUSED.items()}


def unsupported(name: str) -> FormulaError:
    """Say why a function is refused that xlmc does not know, by its name in capitals."""
    if name.startswith("RISKTS"):
        name, hint = name, REFUSED["RiskTSAR1"]
    else:
        name, hint = _BY_NAME.get(name, (name, _SUPPORTED))
    return FormulaError(f"the function {name} is not supported", hint=hint)


def stand_in(call: ir.Call, tabulated: int = 1) -> tuple[ir.Expression, tuple[ir.Expression, ...]]:
    """Return what a call of one of `STAND_INS` stands for, and the values of a `RiskSimtable`.

    Args:
        call: resolved.
        tabulated: which of its values a `RiskSimtable` gives, from 1.

    Raises:
        FormulaError: it has no argument, or more than it takes, or fewer values.
    """
    given = [argument for argument in call.arguments if not is_property(argument)]
    if len(given) != 1 or is_left_out(given[0]):
        name = "RiskSimtable" if call.name == SIMTABLE else "RiskMakeInput"
        takes = "a list of values, such as {10,20,30} or a range" if call.name == SIMTABLE else "one formula"
        raise FormulaError(f"{name} has {len(given)} arguments", hint=f"it takes {takes}")
    if call.name != SIMTABLE:
        return given[0], ()
    values = tuple(elements(given[0]))
    if tabulated > len(values):
        hint = "give every RiskSimtable as many values"
        raise FormulaError(f"RiskSimtable has {len(values)} values, and value {tabulated} is asked for", hint=hint)
    return values[tabulated - 1], values


def simtable_scenarios(
    tables: Mapping[Cell, Sequence[Sequence[ir.Expression]]], findings: Findings
) -> Iterator[Scenario]:
    """Return the scenarios that `RiskSimtable` asks for: with its second value, with its third, … None if it has one.

    Every `RiskSimtable` of the workbook gives its first value in the workbook itself, and its n-th in the scenario of
    that number, over the same random numbers.

    Args:
        tables: the cells with `RiskSimtable` -> the values of each.
        findings: takes the notice that a run uses the first.
    """
    most = max((len(values) for result in tables.values() for values in result), default=1)
    if most == 1:
        return
    first = next(iter(tables))
    message = f"RiskSimtable has {most} values, and a run uses the first; simulate --scenarios runs the others, too"
    findings.notice(message, first)
    for number in range(2, most + 1):
        shown = "; ".join(
            f"{cell} = {', '.join(_shown(values[number - 1]) for values in results if number <= len(values))}"
            for cell, results in tables.items()
        )
        yield Scenario(f"simulation {number}", (Tabulated(number, shown, first),), row=first)


def _shown(value: ir.Expression) -> str:
    """Write a value of a table in words: 2 and not 2.0."""
    return f"{value.value:.15g}" if isinstance(value, ir.Number) else formula_text(value)
