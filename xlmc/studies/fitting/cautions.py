"""What a fit to few values may not be taken for, in words."""

from __future__ import annotations

__all__ = ["FEW", "cautions"]

FEW, ENOUGH = 15, 30
"""Below the first, families cannot be told apart at all; below the second, hardly."""

_CLOSE = 2.0
"""Families whose AIC differ by less are about equally likely (K. P. Burnham and D. R. Anderson, 2002)."""


def cautions(n: int, rivals: list[str]) -> tuple[str, ...]:
    """What a person should know before using a fit.

    Args:
        n: how many values there are.
        rivals: the families whose AIC lies within 2 of the best, the best first.
    """
    said = []
    if n < FEW:
        said.append(
            f"{n} values cannot tell families of distributions apart. Their order is chance as much as evidence; a "
            "uniform range, wide enough for every value that is possible, claims less"
        )
    elif n < ENOUGH:
        said.append(
            f"{n} values tell families of distributions apart only roughly; a uniform range, wide enough for every "
            "value that is possible, claims less"
        )
    if len(rivals) > 1:
        said.append(f"{_listed(rivals)} describe the values about equally well: their AIC lie within {_CLOSE:g}")
    return tuple(said)


def _listed(names: list[str]) -> str:
    return f"{', '.join(names[:-1])} and {names[-1]}"
