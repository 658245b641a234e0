"""Crystal Ball's functions that draw: `CB.Normal(mean, sd)`, each with optional low cutoff, high cutoff and name.

Source: Oracle Crystal Ball User's Guide, "Crystal Ball functions". Arguments in the order of the table below; those of
Lognormal2, Beta2, StudentT, Hypergeometric and Hypergeometric2 are not documented in public.
"""

from __future__ import annotations

from typing import Final

from xlmc.errors import FormulaError
from xlmc.excel.formula import ir
from xlmc.montecarlo.definitions.in_cells.call_arguments import is_left_out
from xlmc.montecarlo.definitions.in_cells.call_draws import Arguments, Drawn, Properties, Signature

__all__ = ["CRYSTAL_BALL", "crystal_ball_draw"]


def _successes(given: Arguments) -> ir.Expression:
    """How many of a population are successes, from their share."""
    return ir.Call("ROUND", (ir.Binary("*", given["share"], given["population"]), ir.Number(0.0)))


CRYSTAL_BALL: Final = {
    "CB.Uniform": Signature("Uniform", ("low", "high")),
    "CB.Triangular": Signature("Triangular", ("low", "likeliest", "high")),
    "CB.Normal": Signature("Normal", ("mean", "std_dev")),
    "CB.Lognormal": Signature("Lognormal", ("mean", "std_dev"), {"location": 0.0}),
    "CB.Lognormal2": Signature("Lognormal", ("location", "mean", "std_dev")),
    "CB.BetaPERT": Signature("BetaPERT", ("low", "likeliest", "high")),
    "CB.Beta": Signature("Beta", ("alpha", "beta", "scale"), {"low": 0.0}, {"high": lambda given: given["scale"]}),
    "CB.Beta2": Signature("Beta", ("low", "high", "alpha", "beta")),
    "CB.Gamma": Signature("Gamma", ("location", "scale", "shape")),
    "CB.Weibull": Signature("Weibull", ("location", "scale", "shape")),
    "CB.Exponential": Signature("Exponential", ("rate",)),
    "CB.Logistic": Signature("Logistic", ("mean", "scale")),
    "CB.Pareto": Signature("Pareto", ("location", "shape")),
    "CB.StudentT": Signature("Student's t", ("midpoint", "scale", "degrees")),
    "CB.MaxExtreme": Signature("Maximum Extreme", ("likeliest", "scale")),
    "CB.MinExtreme": Signature("Minimum Extreme", ("likeliest", "scale")),
    "CB.Custom": Signature("Custom", ("data",)),
    "CB.DiscreteUniform": Signature("Discrete Uniform", ("low", "high")),
    "CB.Binomial": Signature("Binomial", ("probability", "trials")),
    "CB.YesNo": Signature("Yes-No", ("probability",)),
    "CB.Poisson": Signature("Poisson", ("rate",)),
    "CB.Geometric": Signature("Geometric", ("probability",)),
    "CB.NegBinomial": Signature("Negative Binomial", ("probability", "shape")),
    "CB.Hypergeometric": Signature(
        "Hypergeometric", ("share", "trials", "population"), computed={"success": _successes}
    ),
    "CB.Hypergeometric2": Signature("Hypergeometric", ("success", "trials", "population")),
}
"""Function -> what its arguments are."""

_BY_NAME: Final = {name.upper(): (name, signature) for name, signature in CRYSTAL_BALL.items()}


def crystal_ball_draw(call: ir.Call) -> Drawn | None:
    """Return what a call of a Crystal Ball function draws; None if it draws nothing.

    Raises:
        FormulaError: it has too few or too many arguments.
    """
    if call.name not in _BY_NAME:
        return None
    name, signature = _BY_NAME[call.name]
    count = len(signature.takes)
    options = ("name",) if name == "CB.Custom" else ("low cutoff", "high cutoff", "name")
    if not count <= len(call.arguments) <= count + len(options):
        takes = ", ".join((*signature.takes, *(f"[{option}]" for option in options)))
        raise FormulaError(f"{name} has {len(call.arguments)} arguments", hint=f"it takes {takes}")
    given = {
        option: argument
        for option, argument in zip(options, call.arguments[count:], strict=False)
        if not is_left_out(argument)
    }
    properties = Properties(given.get("low cutoff"), given.get("high cutoff"), name=given.get("name"))
    return signature.drawn(name, call.arguments[:count], properties)
