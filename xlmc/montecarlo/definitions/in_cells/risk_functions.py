"""@RISK's and XLRisk's functions that draw: `RiskNormal(mean, sd, RiskTruncate(0, 9))`.

Parameters come first, then property functions in any order. The two programs differ only in `RiskLogNorm` (see
`lognorm`). Alternate forms, `RiskNormalAlt(5%, 10, 95%, 20)` or `RiskTriangAlt("min", 0, "m. likely", 3, 90%, 8)`, take
pairs: what is given, a parameter by its name or a percentile by the probability below, and its value. `RiskNormalAltD`
counts percentiles from above.

Source: Palisade's @RISK manual, "@RISK Functions" and "Alternate Parameters", and the XLRisk manual.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Final

from xlmc.errors import FormulaError
from xlmc.excel.formula import ir
from xlmc.montecarlo.definitions.in_cells.call_arguments import difference, is_left_out, number_of, quotient, total
from xlmc.montecarlo.definitions.in_cells.call_draws import Arguments, Drawn, Properties, Signature
from xlmc.montecarlo.definitions.in_cells.risk_properties import is_property, properties_of
from xlmc.montecarlo.distributions import FAMILIES
from xlmc.montecarlo.distributions.by_percentiles import by_percentiles
from xlmc.montecarlo.number_text import number_text

__all__ = ["ALTERNATES", "RISK", "TRUNCATED", "risk_draw"]

_LOCATED: Final = {"location": 0.0}

_LOGNORM: Final = Signature("Lognormal", ("mean", "std_dev"), _LOCATED)

_LOGNORM2: Final = Signature("Lognorm2", ("mu", "sigma"), _LOCATED)

_LOGNORMS: Final = {"@RISK": _LOGNORM, "XLRisk": _LOGNORM2}
"""What `RiskLognorm(a, b)` means: mean and standard deviation of the draw, or of its logarithm."""

_Pairs = dict[str, ir.Expression]

_Points = dict[float, ir.Expression]

_LOC: Final = {"loc": "location"}

_TWO_SHAPES: Final = {"gamma": "location", "beta": "scale", "alpha1": "shape_1", "alpha2": "shape_2"}

_LIMITS: Final = {"min": "low", "m. likely": "likeliest", "max": "high"}


def _rayleigh_scale(given: Arguments) -> ir.Expression:
    return ir.Binary("*", given["b"], ir.Number(math.sqrt(2)))


def _half_freedom(given: Arguments) -> ir.Expression:
    return quotient(given["freedom"], ir.Number(2.0))


def _erf_deviation(given: Arguments) -> ir.Expression:
    return quotient(math.sqrt(0.5), given["h"])


def _percent_of(name: str) -> Callable[[Arguments], ir.Expression]:
    """Convert a percentage of RiskTrigen; where the upper one is at most 1, both are shares, as XLRisk takes them."""

    def percent(given: Arguments) -> ir.Expression:
        asked, top = given[name], number_of(given["top share"])
        known = number_of(asked)
        share = ir.Binary("*", ir.Number(100.0), asked) if known is None else ir.Number(100 * known)
        if top is not None:
            return share if top <= 1 else asked
        return ir.Call("IF", (ir.Binary("<=", given["top share"], ir.Number(1.0)), share, asked))

    return percent


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
    "RiskCumulD": Signature("CumulD", ("low", "high", "x", "p")),
    "RiskTrigen": Signature(
        "Trigen",
        ("bottom", "likeliest", "top", "bottom share", "top share"),
        computed={"bottom_percent": _percent_of("bottom share"), "top_percent": _percent_of("top share")},
    ),
    "RiskBeta": Signature("Beta", ("alpha", "beta", "low", "high")),
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
    "RiskBetaSubj": Signature("BetaSubj", ("low", "likeliest", "mean", "high")),
    "RiskBurr12": Signature("Burr12", ("location", "scale", "shape_1", "shape_2")),
    "RiskCauchy": Signature("Cauchy", ("location", "scale")),
    "RiskDagum": Signature("Dagum", ("location", "scale", "shape_1", "shape_2")),
    "RiskDoubleTriang": Signature("DoubleTriang", ("low", "likeliest", "high", "lower_share")),
    "RiskErf": Signature("Normal", ("h",), {"mean": 0.0}, {"std_dev": _erf_deviation}),
    "RiskF": Signature("F", ("degrees_1", "degrees_2")),
    "RiskFatigueLife": Signature("Fatigue life", ("location", "scale", "shape")),
    "RiskFrechet": Signature("Frechet", ("location", "scale", "shape")),
    "RiskHypSecant": Signature("Hyperbolic secant", ("mean", "std_dev")),
    "RiskInvGauss": Signature("Inverse Gaussian", ("mean", "shape"), _LOCATED),
    "RiskJohnsonMoments": Signature("Johnson moments", ("mean", "std_dev", "skewness", "kurtosis")),
    "RiskJohnsonSB": Signature("Johnson SB", ("shape_1", "shape_2", "low", "high")),
    "RiskJohnsonSU": Signature("Johnson SU", ("shape_1", "shape_2", "location", "scale")),
    "RiskKumaraswamy": Signature("Kumaraswamy", ("shape_1", "shape_2", "low", "high")),
    "RiskLaplace": Signature("Laplace", ("mean", "std_dev")),
    "RiskLevy": Signature("Levy", ("location", "scale")),
    "RiskLogLogistic": Signature("Log-logistic", ("location", "scale", "shape")),
    "RiskPareto2": Signature("Pareto2", ("scale", "shape"), _LOCATED),
    "RiskPearson5": Signature("Pearson5", ("shape", "scale"), _LOCATED),
    "RiskPearson6": Signature("Pearson6", ("shape_1", "shape_2", "scale"), _LOCATED),
    "RiskReciprocal": Signature("Reciprocal", ("low", "high")),
}
"""Function -> what its arguments are."""

_BY_NAME: Final = {name.upper(): name for name in RISK}


def risk_draw(call: ir.Call, lognorm: str) -> Drawn | None:
    """Return what a call of an @RISK function draws; None if it draws nothing.

    Args:
        call: resolved.
        lognorm: a key of `_LOGNORMS`.

    Raises:
        FormulaError: its arguments or properties are not what they must be.
    """
    count = next((i for i, part in enumerate(call.arguments) if is_property(part)), len(call.arguments))
    given, properties = call.arguments[:count], call.arguments[count:]
    if call.name in TRUNCATED:
        return _truncated(call, lognorm)
    if call.name in _BY_NAME:
        name = _BY_NAME[call.name]
        signature = _LOGNORMS[lognorm] if name == "RiskLognorm" else RISK[name]
        given = _completed(name, given)
        if len(given) != len(signature.takes):
            hint = f"it takes {', '.join(signature.takes)}, and then property functions such as RiskTruncate"
            raise FormulaError(f"{name} has {len(given)} arguments", hint=hint)
        return signature.drawn(name, given, properties_of(name, properties))
    return _alternate_draw(call.name, given, lambda name: properties_of(name, properties))


TRUNCATED: Final = {
    f"RISKT{name.removeprefix('Risk').upper()}": name
    for name in (
        *("RiskChiSq", "RiskErf", "RiskExpon", "RiskExtvalue", "RiskGamma", "RiskInvGauss", "RiskLogistic"),
        *("RiskLogLogistic", "RiskLognorm", "RiskLognorm2", "RiskNormal", "RiskPareto", "RiskPareto2"),
        *("RiskPearson5", "RiskPearson6", "RiskRayleigh", "RiskStudent", "RiskWeibull"),
    )
}
"""Truncated forms of earlier versions, whose last two numbers are the cutoffs -> the function without them."""


def _truncated(call: ir.Call, lognorm: str) -> Drawn | None:
    """Return what `RiskTnormal(mean, sd, min, max)` and its like draw.

    Raises:
        FormulaError: it has too few or too many arguments.
    """
    name = TRUNCATED[call.name]
    count = next((i for i, part in enumerate(call.arguments) if is_property(part)), len(call.arguments))
    if count != len(RISK[name].takes) + 2:
        takes = ", ".join((*RISK[name].takes, "minimum", "maximum"))
        raise FormulaError(f"{name.replace('Risk', 'RiskT', 1)} has {count} arguments", hint=f"it takes {takes}")
    cut = ir.Call("RISKTRUNCATE", call.arguments[count - 2 : count])
    return risk_draw(ir.Call(name.upper(), (*call.arguments[: count - 2], cut, *call.arguments[count:])), lognorm)


_OPTIONAL: Final = {"RiskBeta": (0.0, 1.0)}
"""Function -> its last arguments where they are left out, as XLRisk lets them be."""


def _completed(name: str, given: tuple[ir.Expression, ...]) -> tuple[ir.Expression, ...]:
    """Return the arguments of a call, with those that may be left out."""
    usual = _OPTIONAL.get(name, ())
    first = len(RISK[name].takes) - len(usual)
    if not usual or not first <= len(given) <= len(RISK[name].takes):
        return given
    more = [*given[first:], *([ir.Missing()] * (len(RISK[name].takes) - len(given)))]
    filled = (ir.Number(end) if is_left_out(each) else each for each, end in zip(more, usual, strict=True))
    return *given[:first], *filled


@dataclass(frozen=True, slots=True)
class _Alternate:
    """A family with @RISK's names of its parameters, and those that @RISK's does not have.

    `converted` are the keys of our parameters whose number follows from @RISK's; `mean_above` says that the mean is
    counted from the location.
    """

    family: str
    names: Mapping[str, str]
    fixed: Mapping[str, float] = field(default_factory=dict)
    converted: Mapping[str, Callable[[ir.Expression], ir.Expression]] = field(default_factory=dict)
    mean_above: bool = False


ALTERNATES: Final = {
    "RiskUniform": _Alternate("Uniform", {"min": "low", "max": "high"}),
    "RiskNormal": _Alternate("Normal", {"mu": "mean", "sigma": "std_dev"}),
    "RiskTriang": _Alternate("Triangular", _LIMITS),
    "RiskPert": _Alternate("BetaPERT", _LIMITS),
    "RiskLognorm": _Alternate("Lognormal", {"mu": "mean", "sigma": "std_dev", **_LOC}, mean_above=True),
    "RiskLognorm2": _Alternate("Lognorm2", {"mu": "mu", "sigma": "sigma", **_LOC}),
    "RiskExpon": _Alternate("Exponential", {"beta": "rate"}, converted={"rate": lambda mean: quotient(1.0, mean)}),
    "RiskGamma": _Alternate("Gamma", {"alpha": "shape", "beta": "scale", **_LOC}),
    "RiskWeibull": _Alternate("Weibull", {"alpha": "shape", "beta": "scale", **_LOC}),
    "RiskLogistic": _Alternate("Logistic", {"alpha": "mean", "beta": "scale"}),
    "RiskPareto": _Alternate("Pareto", {"theta": "shape", "a": "location"}),
    "RiskExtvalue": _Alternate("Maximum Extreme", {"a": "likeliest", "b": "scale"}),
    "RiskExtvalueMin": _Alternate("Minimum Extreme", {"a": "likeliest", "b": "scale"}),
    "RiskBetaGeneral": _Alternate("Beta", {"alpha1": "alpha", "alpha2": "beta", "min": "low", "max": "high"}),
    "RiskStudent": _Alternate("Student's t", {"nu": "degrees"}, {"midpoint": 0.0, "scale": 1.0}),
    "RiskBurr12": _Alternate("Burr12", _TWO_SHAPES),
    "RiskCauchy": _Alternate("Cauchy", {"gamma": "location", "beta": "scale"}),
    "RiskChiSq": _Alternate(
        "Gamma",
        {"nu": "shape", **_LOC},
        {"scale": 2.0},
        converted={"shape": lambda freedom: quotient(freedom, ir.Number(2.0))},
    ),
    "RiskDagum": _Alternate("Dagum", _TWO_SHAPES),
    "RiskErf": _Alternate(
        "Normal", {"h": "std_dev"}, {"mean": 0.0}, converted={"std_dev": lambda h: quotient(math.sqrt(0.5), h)}
    ),
    "RiskFatigueLife": _Alternate("Fatigue life", {"y": "location", "beta": "scale", "alpha": "shape"}),
    "RiskFrechet": _Alternate("Frechet", {"gamma": "location", "beta": "scale", "alpha": "shape"}),
    "RiskHypSecant": _Alternate("Hyperbolic secant", {"gamma": "mean", "beta": "std_dev"}),
    "RiskInvGauss": _Alternate("Inverse Gaussian", {"mu": "mean", "lambda": "shape", **_LOC}, mean_above=True),
    "RiskKumaraswamy": _Alternate(
        "Kumaraswamy", {"alpha1": "shape_1", "alpha2": "shape_2", "min": "low", "max": "high"}
    ),
    "RiskLaplace": _Alternate("Laplace", {"mu": "mean", "sigma": "std_dev"}),
    "RiskLevy": _Alternate("Levy", {"a": "location", "c": "scale"}),
    "RiskLogLogistic": _Alternate("Log-logistic", {"gamma": "location", "beta": "scale", "alpha": "shape"}),
    "RiskPareto2": _Alternate("Pareto2", {"b": "scale", "q": "shape", **_LOC}),
    "RiskPearson5": _Alternate("Pearson5", {"alpha": "shape", "beta": "scale", **_LOC}),
    "RiskPearson6": _Alternate("Pearson6", {"alpha1": "shape_1", "alpha2": "shape_2", "beta": "scale", **_LOC}),
    "RiskRayleigh": _Alternate(
        "Weibull",
        {"b": "scale", **_LOC},
        {"shape": 2.0},
        converted={"scale": lambda b: ir.Binary("*", b, ir.Number(math.sqrt(2)))},
    ),
}
"""Function without `Alt` -> its alternate form."""

_ALTERNATES_BY_NAME: Final = {
    f"{name.upper()}ALT{ending}": (f"{name}Alt{ending}", alternate, bool(ending))
    for name, alternate in ALTERNATES.items()
    for ending in ("", "D")
}


def _alternate_draw(
    name: str, arguments: tuple[ir.Expression, ...], properties: Callable[[str], Properties]
) -> Drawn | None:
    """Return what a call of an alternate form draws; otherwise None.

    Args:
        name: of the function, in capitals.
        arguments: those before the property functions.
        properties: reads these; takes the name of the function for messages.

    Raises:
        FormulaError: the pairs are not a distribution of the family.
    """
    if name not in _ALTERNATES_BY_NAME:
        return None
    function, alternate, descending = _ALTERNATES_BY_NAME[name]
    given, points = _pairs(function, alternate, arguments, descending)
    parameters: _Pairs = {key: ir.Number(value) for key, value in alternate.fixed.items()} | given
    if alternate.family == "Uniform":
        return Drawn(
            function, FAMILIES["Uniform"], _uniform(function, parameters, points), properties=properties(function)
        )
    family = FAMILIES[alternate.family]
    if points:
        try:
            family = by_percentiles(family, set(parameters), [_percent(share) for share in points])
        except ValueError as error:
            hint = "give one percentile for each parameter that is left out"
            raise FormulaError(f"{function}: {error}", hint=hint) from None
        parameters |= {f"p{_percent(share):.12g}": value for share, value in points.items()}
    missing = [spec.heading for spec in family.parameters if spec.key not in parameters and spec.default is None]
    if missing:
        raise FormulaError(f"{function} does not say its {missing[0]}", hint="give it, or one more percentile")
    return Drawn(function, family, parameters, properties=properties(function))


def _pairs(
    function: str, alternate: _Alternate, arguments: tuple[ir.Expression, ...], descending: bool
) -> tuple[_Pairs, _Points]:
    """Return the parameters by our key, and the percentiles by the probability below them, rising."""
    if len(arguments) % 2 or not arguments:
        raise FormulaError(f"{function} has {len(arguments)} arguments", hint="give pairs: what, and its value")
    given: _Pairs = {}
    points: _Points = {}
    for what, value in zip(arguments[::2], arguments[1::2], strict=True):
        if isinstance(what, ir.Text):
            key = alternate.names.get(what.value.strip().casefold())
            if key is None:
                raise FormulaError(
                    f"{function} has no parameter {what.value!r}",
                    hint=f"use {', '.join(map(repr, alternate.names))}, or a percentile such as 5%",
                )
            taken, named = key in given, key
            given[key] = alternate.converted[key](value) if key in alternate.converted else value
        else:
            share = _share(function, what, descending)
            taken, named = share in points, f"{number_text(100 * share)} %"
            points[share] = value
        if taken:
            raise FormulaError(f"{function} is given {named} twice", hint="keep one of them")
    if alternate.mean_above and "location" in given and "mean" in given:
        given["mean"] = total(given["mean"], given["location"])
    return given, dict(sorted(points.items()))


def _percent(share: float) -> float:
    return round(100 * share, 10)


def _share(function: str, what: ir.Expression, descending: bool) -> float:
    share = number_of(what)
    if share is None or not 0 < share < 1:
        hint = "write probabilities such as 5% or 0.05, and names of parameters in quotes"
        raise FormulaError(f"{function} has a percentile that is not between 0 and 1", hint=hint)
    return round(1 - share if descending else share, 15)


def _uniform(function: str, given: _Pairs, points: _Points) -> _Pairs:
    """Return the limits of a Uniform through what is given: a straight line of values over probabilities."""
    known = dict(points)
    known |= {end: given[key] for key, end in (("low", 0.0), ("high", 1.0)) if key in given}
    if len(known) != 2:
        raise FormulaError(f"{function} is given {len(known)} values", hint="give two: limits or percentiles")
    (p, x), (q, y) = sorted(known.items(), key=lambda item: item[0])
    slope = quotient(difference(y, x), ir.Number(q - p))
    low = difference(x, ir.Binary("*", ir.Number(p), slope))
    high = total(x, ir.Binary("*", ir.Number(1 - p), slope))
    return {"low": given.get("low", low), "high": given.get("high", high)}
