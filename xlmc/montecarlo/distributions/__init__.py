"""Families of distributions, one file each, and how they are found by the name a person types.

To add one, write a module beside this one with a subclass of `Family`, list it here, and write its page anew with
`python docs/list_distributions.py`. docs/adding.md has an example.
"""

from __future__ import annotations

from functools import cache
from typing import Final

from xlmc.errors import DefinitionError
from xlmc.montecarlo.distributions.base import Family
from xlmc.montecarlo.distributions.beta import Beta
from xlmc.montecarlo.distributions.beta_pert import BetaPERT
from xlmc.montecarlo.distributions.beta_subj import BetaSubj
from xlmc.montecarlo.distributions.binomial import Binomial
from xlmc.montecarlo.distributions.burr12 import Burr12
from xlmc.montecarlo.distributions.by_moments import ByMoments
from xlmc.montecarlo.distributions.by_percentiles import ByPercentiles
from xlmc.montecarlo.distributions.cauchy import Cauchy
from xlmc.montecarlo.distributions.cumul import Cumul, CumulD
from xlmc.montecarlo.distributions.custom import Custom
from xlmc.montecarlo.distributions.dagum import Dagum
from xlmc.montecarlo.distributions.discrete import Discrete, DUniform
from xlmc.montecarlo.distributions.discrete_uniform import DiscreteUniform
from xlmc.montecarlo.distributions.double_triang import DoubleTriang
from xlmc.montecarlo.distributions.empirical import Empirical
from xlmc.montecarlo.distributions.empirical_smoothed import EmpiricalSmoothed
from xlmc.montecarlo.distributions.exponential import Exponential
from xlmc.montecarlo.distributions.extreme_value import MaximumExtreme, MinimumExtreme
from xlmc.montecarlo.distributions.f_distribution import F
from xlmc.montecarlo.distributions.fatigue_life import FatigueLife
from xlmc.montecarlo.distributions.frechet import Frechet
from xlmc.montecarlo.distributions.gamma import Gamma
from xlmc.montecarlo.distributions.general import General
from xlmc.montecarlo.distributions.geometric import Geomet, Geometric
from xlmc.montecarlo.distributions.histogrm import Histogrm
from xlmc.montecarlo.distributions.hyperbolic_secant import HyperbolicSecant
from xlmc.montecarlo.distributions.hypergeometric import Hypergeometric
from xlmc.montecarlo.distributions.inverse_gaussian import InverseGaussian
from xlmc.montecarlo.distributions.johnson_moments import JohnsonMoments
from xlmc.montecarlo.distributions.johnson_sb import JohnsonSB
from xlmc.montecarlo.distributions.johnson_su import JohnsonSU
from xlmc.montecarlo.distributions.kumaraswamy import Kumaraswamy
from xlmc.montecarlo.distributions.laplace import Laplace
from xlmc.montecarlo.distributions.levy import Levy
from xlmc.montecarlo.distributions.log_logistic import LogLogistic
from xlmc.montecarlo.distributions.logistic import Logistic
from xlmc.montecarlo.distributions.lognormal import Lognorm2, Lognormal
from xlmc.montecarlo.distributions.negative_binomial import NegativeBinomial, Negbin
from xlmc.montecarlo.distributions.normal import Normal
from xlmc.montecarlo.distributions.parameters import DataError, DataSpec, Fault, ParameterSpec
from xlmc.montecarlo.distributions.pareto import Pareto
from xlmc.montecarlo.distributions.pareto2 import Pareto2
from xlmc.montecarlo.distributions.pearson5 import Pearson5
from xlmc.montecarlo.distributions.pearson6 import Pearson6
from xlmc.montecarlo.distributions.piecewise import Piecewise
from xlmc.montecarlo.distributions.poisson import Poisson
from xlmc.montecarlo.distributions.reciprocal import Reciprocal
from xlmc.montecarlo.distributions.spelling import did_you_mean, plain
from xlmc.montecarlo.distributions.students_t import StudentsT
from xlmc.montecarlo.distributions.trapezoid import Trapezoid
from xlmc.montecarlo.distributions.triangular import Triangular
from xlmc.montecarlo.distributions.trigen import Trigen
from xlmc.montecarlo.distributions.truncated import Truncated
from xlmc.montecarlo.distributions.uniform import Uniform
from xlmc.montecarlo.distributions.weibull import Weibull
from xlmc.montecarlo.distributions.yes_no import YesNo

__all__ = [
    "FAMILIES",
    "ByMoments",
    "ByPercentiles",
    "DataError",
    "DataSpec",
    "Family",
    "Fault",
    "ParameterSpec",
    "Piecewise",
    "Truncated",
    "family_named",
]

_CONTINUOUS = (
    Uniform(),
    Triangular(),
    Trapezoid(),
    Normal(),
    Beta(),
    BetaPERT(),
    Exponential(),
    Gamma(),
    Logistic(),
    Lognormal(),
    Lognorm2(),
    MaximumExtreme(),
    MinimumExtreme(),
    Pareto(),
    StudentsT(),
    Trigen(),
    Weibull(),
    BetaSubj(),
    Burr12(),
    Cauchy(),
    Dagum(),
    DoubleTriang(),
    F(),
    FatigueLife(),
    Frechet(),
    HyperbolicSecant(),
    InverseGaussian(),
    JohnsonMoments(),
    JohnsonSB(),
    JohnsonSU(),
    Kumaraswamy(),
    Laplace(),
    Levy(),
    LogLogistic(),
    Pareto2(),
    Pearson5(),
    Pearson6(),
    Reciprocal(),
    Cumul(),
    CumulD(),
    General(),
    Histogrm(),
)

_COUNTS = (
    Binomial(),
    DiscreteUniform(),
    Geometric(),
    Geomet(),
    Hypergeometric(),
    NegativeBinomial(),
    Negbin(),
    Poisson(),
    YesNo(),
)
_OF_DATA = (Custom(), Discrete(), DUniform(), Empirical(), EmpiricalSmoothed())

FAMILIES: Final[dict[str, Family]] = {family.name: family for family in (*_CONTINUOUS, *_COUNTS, *_OF_DATA)}
"""Every family by its name."""


@cache
def _spellings() -> dict[str, Family]:
    """Every plain name that a person may type -> its family."""
    return {plain(name): family for family in FAMILIES.values() for name in (family.name, *family.aliases)}


def family_named(name: str, where: object = None) -> Family:
    """Return the family a person means; case, blanks, underscores and hyphens do not count.

    Args:
        name: as typed.
        where: the cell the name stands in, for the message.

    Raises:
        DefinitionError: no family has that name.
    """
    family = _spellings().get(plain(name))
    if family is None:
        message = f"{name.strip()!r} is not a distribution of this version"
        raise DefinitionError(message, where=where, hint=did_you_mean(name, FAMILIES))
    return family
