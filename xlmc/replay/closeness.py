"""Whether a value in a file is the one that the repeated run gives."""

from __future__ import annotations

from dataclasses import dataclass
from decimal import ROUND_DOWN, ROUND_HALF_EVEN, ROUND_HALF_UP, Context, Decimal
from typing import Final, TypeGuard

from xlmc.workbook.model import CellValue

__all__ = ["Closeness", "is_number"]

_ROUNDING: Final = 1e-12
_OTHER_PROGRAM: Final = 1e-9
"""How far another program's value of a formula may differ, relative to it."""


@dataclass(frozen=True, slots=True)
class Closeness:
    """How far numbers may be apart.

    Attributes:
        rewritten: another program has saved the file; some write only 15 digits, and other line ends.
        elsewhere: the run was made with other software or on another processor, which may round differently.
    """

    rewritten: bool = False
    elsewhere: bool = False

    def equal(self, says: CellValue, gives: CellValue, scale: float = 0.0, *, computed: bool = False) -> bool:
        """Whether a value is the one the run gives.

        Args:
            says: what the file holds.
            gives: what the run gives.
            scale: the largest number beside it, from which it may have been computed.
            computed: the file holds a formula, whose value another program may have computed again.
        """
        if is_number(says) and is_number(gives):
            apart = abs(says - gives)
            if apart <= self._apart(max(abs(says), abs(gives)), scale, computed):
                return True
            return self.rewritten and float(says) in _with_fewer_digits(gives)
        if self.rewritten and isinstance(says, str) and isinstance(gives, str):
            return says.splitlines() == gives.splitlines()
        return type(says) is type(gives) and says == gives

    def _apart(self, size: float, scale: float, computed: bool) -> float:
        """How far two numbers of this size may be apart."""
        rewritten = _OTHER_PROGRAM * size if self.rewritten and computed else 0.0
        return max(rewritten, _ROUNDING * max(size, scale) if self.elsewhere else 0.0)


def _with_fewer_digits(number: float) -> set[float]:
    """The number as programs write it: 15 or 16 digits of its shortest or its exact decimal, rounded or cut off."""
    shortest, exact = Decimal(repr(float(number))), Decimal(float(number))
    rules = [(15, ROUND_DOWN), *((digits, rule) for digits in (15, 16) for rule in (ROUND_HALF_UP, ROUND_HALF_EVEN))]
    return {
        float(Context(prec=digits, rounding=rule).plus(whole)) for digits, rule in rules for whole in (shortest, exact)
    }


def is_number(value: CellValue) -> TypeGuard[int | float]:
    """Whether a value is a number, and not a logical."""
    return isinstance(value, int | float) and not isinstance(value, bool)
