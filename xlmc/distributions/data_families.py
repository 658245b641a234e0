"""The distributions that are made from a range of data instead of parameters."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from xlmc.distributions.base import Family
from xlmc.distributions.custom import Custom
from xlmc.distributions.custom_data import BadData, Row, custom_pieces, value_pieces, weighted_pieces
from xlmc.distributions.empirical_smoothed import EmpiricalSmoothed, silverman
from xlmc.distributions.naming import plain

__all__ = ["DATA_FAMILIES", "DataFamily", "DataOptions", "data_family_named"]

_MOST_CELLS = 200_000


@dataclass(frozen=True, slots=True)
class DataOptions:
    """What beside the data says how to read them."""

    cumulative: bool = False
    bandwidth: float | None = None


@dataclass(frozen=True, slots=True)
class DataFamily:
    """A way to make a distribution from data.

    Attributes:
        make: from rows of equal length, None where a cell is blank; raises `BadData`.
        options: the columns of the assumptions table, beside Data, that it reads.
        truncates: whether it may have cutoffs.
    """

    name: str
    make: Callable[[Sequence[Row], DataOptions], Family]
    aliases: tuple[str, ...] = ()
    options: tuple[str, ...] = ()
    truncates: bool = True


def _custom(rows: Sequence[Row], options: DataOptions) -> Family:
    return Custom(custom_pieces(rows, cumulative=options.cumulative))


def _discrete(rows: Sequence[Row], options: DataOptions) -> Family:
    _refuse_columns(rows, 2, "Discrete takes two columns, values and their probabilities")
    return Custom(weighted_pieces(rows, cumulative=options.cumulative), "Discrete")


def _discrete_values(rows: Sequence[Row], _: DataOptions) -> Family:
    return Custom(value_pieces(rows), "DUniform")


def _empirical(rows: Sequence[Row], _: DataOptions) -> Family:
    return Custom(value_pieces(rows), "Empirical")


def _smoothed(rows: Sequence[Row], options: DataOptions) -> Family:
    values = [value for row in rows for value in row if value is not None]
    value_pieces(rows)  # refuses what is no data
    bandwidth = silverman(values) if options.bandwidth is None else options.bandwidth
    if not bandwidth > 0:
        message = "The values are all equal, so nothing says how far to smooth them"
        raise BadData(message, "Give a Bandwidth, or more measurements", (0, 0))
    if EmpiricalSmoothed.cells_needed(values, bandwidth) > _MOST_CELLS:
        message = "The bandwidth is very small beside the spread of so many values"
        raise BadData(message, "Give a larger Bandwidth, or use Empirical without smoothing", (0, 0))
    return EmpiricalSmoothed(values, bandwidth)


def _refuse_columns(rows: Sequence[Row], columns: int, message: str) -> None:
    if len(rows[0]) != columns:
        raise BadData(f"{message}; these data have {len(rows[0])}", "Correct the range under Data", (0, 0))


DATA_FAMILIES: Mapping[str, DataFamily] = {
    family.name: family
    for family in (
        DataFamily("Custom", _custom, options=("Cumulative",), truncates=False),
        DataFamily("Discrete", _discrete, options=("Cumulative",)),
        DataFamily("DUniform", _discrete_values, aliases=("Discrete values",)),
        DataFamily("Empirical", _empirical, aliases=("Resampled",)),
        DataFamily("Empirical smoothed", _smoothed, aliases=("Kernel density", "KDE"), options=("Bandwidth",)),
    )
}
"""Every one by its name."""

_SPELLINGS = {plain(name): family for family in DATA_FAMILIES.values() for name in (family.name, *family.aliases)}


def data_family_named(name: str) -> DataFamily | None:
    """The one a person means, spelt as `family_named` allows; None where the name is of another kind."""
    return _SPELLINGS.get(plain(name))
