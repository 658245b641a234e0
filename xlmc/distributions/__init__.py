"""Families of distributions, one file each, and how they are found by the name a person types."""

from __future__ import annotations

from collections.abc import Mapping

from xlmc.distributions.base import DataError, DataSpec, Family, Fault, ParameterSpec
from xlmc.distributions.binomial import Binomial
from xlmc.distributions.custom import Custom
from xlmc.distributions.discrete import Discrete
from xlmc.distributions.discrete_uniform import DiscreteUniform
from xlmc.distributions.discrete_values import DUniform
from xlmc.distributions.empirical import Empirical
from xlmc.distributions.empirical_smoothed import EmpiricalSmoothed
from xlmc.distributions.geomet import Geomet
from xlmc.distributions.geometric import Geometric
from xlmc.distributions.hypergeometric import Hypergeometric
from xlmc.distributions.naming import did_you_mean, plain
from xlmc.distributions.negative_binomial import NegativeBinomial
from xlmc.distributions.negbin import Negbin
from xlmc.distributions.normal import Normal
from xlmc.distributions.poisson import Poisson
from xlmc.distributions.trapezoid import Trapezoid
from xlmc.distributions.triangular import Triangular
from xlmc.distributions.truncated import Truncated
from xlmc.distributions.uniform import Uniform
from xlmc.distributions.yes_no import YesNo
from xlmc.errors import DefinitionError

__all__ = [
    "FAMILIES",
    "DataError",
    "DataSpec",
    "Family",
    "Fault",
    "ParameterSpec",
    "Truncated",
    "family_named",
]

_CONTINUOUS = (Uniform(), Normal(), Triangular(), Trapezoid())
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

FAMILIES: Mapping[str, Family] = {family.name: family for family in (*_CONTINUOUS, *_COUNTS, *_OF_DATA)}
"""Every family by its name."""

_SPELLINGS = {plain(spelling): family for family in FAMILIES.values() for spelling in (family.name, *family.aliases)}


def family_named(name: str, where: object = None) -> Family:
    """The family a person means; case, blanks, underscores and hyphens do not count.

    Args:
        name: as typed.
        where: the cell the name stands in, for the message.

    Raises:
        DefinitionError: no family has that name.
    """
    family = _SPELLINGS.get(plain(name))
    if family is None:
        message = f"{name.strip()!r} is not a distribution of this version"
        raise DefinitionError(message, where=where, hint=did_you_mean(name, FAMILIES))
    return family
