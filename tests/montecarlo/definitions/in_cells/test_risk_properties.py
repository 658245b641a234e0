from __future__ import annotations

import pytest

from xlmc.errors import FormulaError
from xlmc.excel.address import Cell
from xlmc.excel.formula import ir
from xlmc.montecarlo.definitions.in_cells.risk_properties import properties_of

ARGUMENTS = {
    "RiskTruncate": (0, 2),
    "RiskTruncate2": (0, 2),
    "RiskShift": (1, 1),
    "RiskStatic": (1, 1),
    "RiskIndepC": (1, 1),
    "RiskDepC": (2, 2),
    "RiskSeed": (0, 2),
    "RiskCollect": (0, 1),
    "RiskCategory": (0, 1),
    "RiskConvergence": (0, 9),
    "RiskFit": (0, 9),
    "RiskIsDate": (0, 1),
    "RiskIsDiscrete": (0, 1),
    "RiskSixSigma": (0, 9),
}
"""Fewest and most arguments."""


def call(name, *arguments):
    return ir.Call(name.upper(), arguments)


@pytest.mark.parametrize("name", ARGUMENTS)
def test_a_property_function_takes_so_many_arguments(name):
    fewest, most = ARGUMENTS[name]
    text = name in ("RiskIndepC", "RiskDepC")
    for count in (fewest, most):
        given = [ir.Number(0.5)] * count
        if text:
            given[0] = ir.Text("other")
        properties_of("RiskNormal", (call(name, *given),))
    for count in {fewest - 1, most + 1} - {-1}:
        with pytest.raises(FormulaError) as caught:
            properties_of("RiskNormal", (call(name, *[ir.Number(0.5)] * count),))
        takes = str(fewest) if fewest == most else f"{fewest} to {most}"
        assert f"{name} has {count} arguments; it takes {takes}" in str(caught.value)


@pytest.mark.parametrize(
    ("arguments", "percents"),
    [
        ((ir.Number(0.0), ir.Number(1.0)), (0.0, 1.0)),
        ((ir.Number(0.05),), (0.05, 1.0)),
        ((ir.Missing(), ir.Number(0.9)), (0.0, 0.9)),
        ((ir.Number(-0.01), ir.Number(0.9)), None),
        ((ir.Number(0.1), ir.Number(1.01)), None),
        ((ir.Number(0.5), ir.Number(0.5)), None),
        ((Cell("S", 1, 1), ir.Number(0.5)), None),
        ((ir.Number(0.5), Cell("S", 1, 1)), None),
    ],
)
def test_cutoffs_as_probabilities_lie_between_0_and_1_and_rise(arguments, percents):
    calls = (call("RiskTruncateP", *arguments),)
    if percents is not None:
        assert properties_of("RiskNormal", calls).percents == percents
        return
    with pytest.raises(FormulaError, match="takes two probabilities"):
        properties_of("RiskNormal", calls)


def test_only_the_second_truncation_is_behind_the_shift():
    for name, shifted in [("RiskTruncate", False), ("RiskTruncate2", True)]:
        result = properties_of("RiskNormal", (call(name, ir.Number(1.0), ir.Number(2.0)),))
        assert (result.lower, result.upper, result.shifted_cutoffs) == (ir.Number(1.0), ir.Number(2.0), shifted)
