"""Families of distributions, one file each, and how they are found by the name a person types.

To add one, write a module beside this one with a subclass of `Family`, list it here, and write its page anew with
`python docs/list_distributions.py`. docs/adding.md has an example.
"""

from __future__ import annotations

from functools import cache
from typing import Final

from xlmc.distributions.base import Family
from xlmc.distributions.beta import Beta
from xlmc.distributions.beta_pert import BetaPERT
from xlmc.distributions.beta_subj import BetaSubj
from xlmc.distributions.binomial import Binomial
from xlmc.distributions.burr12 import Burr12
from xlmc.distributions.by_percentiles import ByPercentiles
from xlmc.distributions.cauchy import Cauchy
from xlmc.distributions.cumul import Cumul, CumulD
from xlmc.distributions.custom import Custom
from xlmc.distributions.dagum import Dagum
from xlmc.distributions.discrete import Discrete, DUniform
from xlmc.distributions.discrete_uniform import DiscreteUniform
from xlmc.distributions.double_triang import DoubleTriang
from xlmc.distributions.empirical import Empirical
from xlmc.distributions.empirical_smoothed import EmpiricalSmoothed
from xlmc.distributions.exponential import Exponential
from xlmc.distributions.extreme_value import MaximumExtreme, MinimumExtreme
from xlmc.distributions.f_distribution import F
from xlmc.distributions.fatigue_life import FatigueLife
from xlmc.distributions.frechet import Frechet
from xlmc.distributions.gamma import Gamma
from xlmc.distributions.general import General
from xlmc.distributions.geometric import Geomet, Geometric
from xlmc.distributions.histogrm import Histogrm
from xlmc.distributions.hyperbolic_secant import HyperbolicSecant
from xlmc.distributions.hypergeometric import Hypergeometric
from xlmc.distributions.inverse_gaussian import InverseGaussian
from xlmc.distributions.johnson_moments import JohnsonMoments
from xlmc.distributions.johnson_sb import JohnsonSB
from xlmc.distributions.johnson_su import JohnsonSU
from xlmc.distributions.kumaraswamy import Kumaraswamy
from xlmc.distributions.laplace import Laplace
from xlmc.distributions.levy import Levy
from xlmc.distributions.log_logistic import LogLogistic
from xlmc.distributions.logistic import Logistic
from xlmc.distributions.lognormal import Lognorm2, Lognormal
from xlmc.distributions.negative_binomial import NegativeBinomial, Negbin
from xlmc.distributions.normal import Normal
from xlmc.distributions.parameters import DataError, DataSpec, Fault, ParameterSpec
from xlmc.distributions.pareto import Pareto
from xlmc.distributions.pareto2 import Pareto2
from xlmc.distributions.pearson5 import Pearson5
from xlmc.distributions.pearson6 import Pearson6
from xlmc.distributions.piecewise import Piecewise
from xlmc.distributions.poisson import Poisson
from xlmc.distributions.reciprocal import Reciprocal
from xlmc.distributions.spelling import did_you_mean, plain
from xlmc.distributions.students_t import StudentsT
from xlmc.distributions.trapezoid import Trapezoid
from xlmc.distributions.triangular import Triangular
from xlmc.distributions.trigen import Trigen
from xlmc.distributions.truncated import Truncated
from xlmc.distributions.uniform import Uniform
from xlmc.distributions.weibull import Weibull
from xlmc.distributions.yes_no import YesNo
from xlmc.errors import DefinitionError

__all__ = [
    "FAMILIES",
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
    """The family a person means; case, blanks, underscores and hyphens do not count.

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
