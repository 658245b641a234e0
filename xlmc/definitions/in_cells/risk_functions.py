"""@RISK's and XLRisk's functions that draw: `RiskNormal(mean, sd, RiskTruncate(0, 9))`.

Parameters come first, then property functions in any order. Source: Palisade's @RISK manual, "@RISK Functions", and the
XLRisk manual; the two differ only in `RiskLogNorm` (see `lognorm`).
"""

from __future__ import annotations

import math
from typing import Final

from xlmc.definitions.in_cells.draws import Arguments, Drawn, Signature
from xlmc.definitions.in_cells.risk_percentiles import alternate_draw
from xlmc.definitions.in_cells.risk_properties import is_property, properties_of
from xlmc.definitions.in_cells.trees import quotient
from xlmc.errors import FormulaError
from xlmc.formula import ir

__all__ = ["LOGNORMS", "RISK", "risk_draw"]


def _rayleigh_scale(given: Arguments) -> ir.Expression:
    return ir.Binary("*", given["b"], ir.Number(math.sqrt(2)))


def _half_freedom(given: Arguments) -> ir.Expression:
    return quotient(given["freedom"], ir.Number(2.0))


_LOCATED: Final = {"location": 0.0}
_LOGNORM: Final = Signature("Lognormal", ("mean", "std_dev"), _LOCATED)
_LOGNORM2: Final = Signature("Lognorm2", ("mu", "sigma"), _LOCATED)

LOGNORMS: Final = {"@RISK": _LOGNORM, "XLRisk": _LOGNORM2}
"""What `RiskLognorm(a, b)` means: mean and standard deviation of the draw, or of its logarithm."""

RISK: Final = {
    "RiskUniform": Signature("Uniform", ("low", "high")),
    "RiskNormal": Signature("Normal", ("mean", "std_dev")),
    "RiskTriang": Signature("Triangular", ("low", "likeliest", "high")),
    "RiskPert": Signature("BetaPERT", ("low", "likeliest", "high")),
    "RiskLognorm": _LOGNORM,
    "RiskLognorm2": _LOGNORM2,
    "RiskDiscrete": Signature("Discrete", ("x", "p")),
    "RiskDUniform": Signature("DUniform", ("x",)),
    "RiskHistogrm": Signature("Histogrm", ("low", "high", "p")),
    "RiskCumul": Signature("Cumul", ("low", "high", "x", "p")),
    "RiskGeneral": Signature("General", ("low", "high", "x", "p")),
    "RiskTrigen": Signature("Trigen", ("bottom", "likeliest", "top", "bottom_percent", "top_percent")),
    "RiskBeta": Signature("Beta", ("alpha", "beta"), {"low": 0.0, "high": 1.0}),
    "RiskBetaGeneral": Signature("Beta", ("alpha", "beta", "low", "high")),
    "RiskGamma": Signature("Gamma", ("shape", "scale"), _LOCATED),
    "RiskErlang": Signature("Gamma", ("shape", "scale"), _LOCATED),
    "RiskChiSq": Signature("Gamma", ("freedom",), _LOCATED | {"scale": 2.0}, {"shape": _half_freedom}),
    "RiskWeibull": Signature("Weibull", ("shape", "scale"), _LOCATED),
    "RiskRayleigh": Signature("Weibull", ("b",), _LOCATED | {"shape": 2.0}, {"scale": _rayleigh_scale}),
    "RiskExpon": Signature("Exponential", ("mean",), computed={"rate": lambda given: quotient(1.0, given["mean"])}),
    "RiskLogistic": Signature("Logistic", ("mean", "scale")),
    "RiskPareto": Signature("Pareto", ("shape", "location")),
    "RiskStudent": Signature("Student's t", ("degrees",), {"midpoint": 0.0, "scale": 1.0}),
    "RiskBinomial": Signature("Binomial", ("trials", "probability")),
    "RiskBernoulli": Signature("Yes-No", ("probability",)),
    "RiskPoisson": Signature("Poisson", ("rate",)),
    "RiskNegbin": Signature("Negbin", ("shape", "probability")),
    "RiskGeomet": Signature("Geomet", ("probability",)),
    "RiskHypergeo": Signature("Hypergeometric", ("trials", "success", "population")),
    "RiskIntUniform": Signature("Discrete Uniform", ("low", "high")),
    "RiskExtvalue": Signature("Maximum Extreme", ("likeliest", "scale")),
    "RiskExtvalueMin": Signature("Minimum Extreme", ("likeliest", "scale")),
}
"""Function -> what its arguments are."""

_BY_NAME: Final = {name.upper(): name for name in RISK}


def risk_draw(call: ir.Call, lognorm: str) -> Drawn | None:
    """What a call of an @RISK function draws; None where it is none that draws.

    Args:
        call: resolved.
        lognorm: a key of `LOGNORMS`.

    Raises:
        FormulaError: its arguments or properties are not what they must be.
    """
    count = next((i for i, part in enumerate(call.arguments) if is_property(part)), len(call.arguments))
    given, properties = call.arguments[:count], call.arguments[count:]
    if call.name in _BY_NAME:
        name = _BY_NAME[call.name]
        signature = LOGNORMS[lognorm] if name == "RiskLognorm" else RISK[name]
        if len(given) != len(signature.takes):
            hint = f"it takes {', '.join(signature.takes)}, and then property functions such as RiskTruncate"
            raise FormulaError(f"{name} has {len(given)} arguments", hint=hint)
        return signature.drawn(name, given, properties_of(name, properties))
    return alternate_draw(call.name, given, lambda name: properties_of(name, properties))
