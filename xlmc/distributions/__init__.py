"""Families of distributions, one file each, and how they are found by the name a person types."""

from __future__ import annotations

from collections.abc import Mapping

from xlmc.distributions.base import Family, Fault, ParameterSpec
from xlmc.distributions.by_percentiles import ByPercentiles
from xlmc.distributions.naming import did_you_mean, plain
from xlmc.distributions.normal import Normal
from xlmc.distributions.trapezoid import Trapezoid
from xlmc.distributions.triangular import Triangular
from xlmc.distributions.truncated import Truncated
from xlmc.distributions.uniform import Uniform
from xlmc.errors import DefinitionError

__all__ = ["FAMILIES", "ByPercentiles", "Family", "Fault", "ParameterSpec", "Truncated", "family_named"]

_CONTINUOUS = (Uniform(), Normal(), Triangular(), Trapezoid())

FAMILIES: Mapping[str, Family] = {family.name: family for family in _CONTINUOUS}
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
