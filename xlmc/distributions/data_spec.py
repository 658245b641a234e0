"""What a family that is built from data needs, and what is wrong with data that it cannot use."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["DataError", "DataSpec"]


@dataclass(frozen=True, slots=True)
class DataSpec:
    """What the range under Data must hold for a family that is built from data.

    Attributes:
        columns: the numbers of columns it may have; empty for any.
        content: what the columns are, for people: `values, cumulative probabilities`.
        options: headings of the assumptions table that say how to read it; `built` takes them in small letters.
        truncates: whether what is built may have cutoffs.
    """

    columns: tuple[int, ...]
    content: str
    options: tuple[str, ...] = ()
    truncates: bool = True


class DataError(ValueError):
    """Numbers that no distribution can be built from.

    Attributes:
        message, hint: what is wrong, and what to do; `{also}` in the message stands for the second place.
        row, column: where to look first, counted from 0; None for the data as a whole.
        also: the row and column that it disagrees with.
    """

    def __init__(
        self,
        message: str,
        hint: str,
        row: int | None = None,
        column: int | None = None,
        also: tuple[int, int] | None = None,
    ) -> None:
        super().__init__(message)
        self.message, self.hint, self.row, self.column, self.also = message, hint, row, column, also
