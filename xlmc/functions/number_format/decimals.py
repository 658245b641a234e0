"""Places for digits before and after a point, and the same with an exponent: `#,##0.00`, `0.0%`, `##0.0E+0`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from decimal import ROUND_HALF_UP, Context, Decimal
from typing import Final

from xlmc.functions.number_format.placeholders import count_digits, fill_decimals, fill_whole, settle_commas
from xlmc.functions.number_format.plain import Written
from xlmc.functions.number_format.tokens import FormatError, Mark, Token
from xlmc.functions.number_text import shown

__all__ = ["DecimalLayout", "ExponentLayout", "decimal_layout", "exponent_layout"]

_WIDE: Final = Context(prec=1000, rounding=ROUND_HALF_UP)
"""Enough for any number with as many decimals as a format can ask for."""


@dataclass(frozen=True, slots=True)
class DecimalLayout:
    """Places for digits.

    Attributes:
        before: the tokens up to the point.
        after: the tokens from behind the point; None without a point.
        scale: powers of ten to multiply by first, from percent signs and commas.
    """

    before: tuple[Token, ...]
    after: tuple[Token, ...] | None
    grouped: bool
    scale: int

    @property
    def decimals(self) -> int:
        return count_digits(self.after or ())

    def write(self, size: float, date1904: bool = False) -> Written:
        number = shown(size).scaleb(self.scale).quantize(Decimal(1).scaleb(-self.decimals), context=_WIDE)
        whole, _, decimals = f"{number:f}".partition(".")
        return self.filled(whole.lstrip("0"), decimals), not number

    def filled(self, whole: str, decimals: str) -> str:
        """The digits in their places; without a place before the point, whole digits stand before it all the same."""
        text = fill_whole(self.before, whole, self.grouped)
        if self.after is None:
            return text
        return f"{text}{'' if count_digits(self.before) else whole}.{fill_decimals(self.after, decimals)}"


def decimal_layout(tokens: Sequence[Token]) -> DecimalLayout:
    """The layout of a section with places for digits."""
    settled, grouped, thousands = settle_commas(tokens)
    percents = sum(token.mark is Mark.PERCENT for token in tokens)
    points = [index for index, token in enumerate(settled) if token.mark is Mark.POINT]
    split = points[0] if points else len(settled)
    after = tuple(settled[split + 1 :]) if points else None
    return DecimalLayout(tuple(settled[:split]), after, grouped, 2 * percents - 3 * thousands)


@dataclass(frozen=True, slots=True)
class ExponentLayout:
    """A mantissa and an exponent, which is a multiple of the count of places before the point.

    Attributes:
        mark: `E+` or `E-`, as written; the latter writes no plus.
    """

    mantissa: DecimalLayout
    mark: str
    power: tuple[Token, ...]

    def write(self, size: float, date1904: bool = False) -> Written:
        number = shown(size)
        if not number:
            zeros = "0" * count_digits(self.mantissa.before)
            return self.mantissa.filled(zeros, "") + self._power(0), False
        step = max(count_digits(self.mantissa.before), 1)
        power = self._step_down(number.adjusted(), step)
        mantissa = self._rounded(number, power)
        if mantissa.adjusted() >= power_limit(self.mantissa):
            power += step
            mantissa = self._rounded(number, power)
        whole, _, decimals = f"{mantissa:f}".partition(".")
        return self.mantissa.filled(whole.lstrip("0"), decimals) + self._power(power), False

    def _step_down(self, exponent: int, step: int) -> int:
        no_whole = not count_digits(self.mantissa.before)
        return exponent + 1 if no_whole else exponent // step * step

    def _rounded(self, number: Decimal, power: int) -> Decimal:
        return number.scaleb(-power).quantize(Decimal(1).scaleb(-self.mantissa.decimals), context=_WIDE)

    def _power(self, power: int) -> str:
        sign = "-" if power < 0 else "+" if self.mark[1] == "+" else ""
        start = next(index for index, token in enumerate(self.power) if token.mark is Mark.DIGIT)
        between = "".join(token.text for token in self.power[:start])
        return f"{self.mark[0]}{between}{sign}{fill_whole(self.power[start:], str(abs(power)))}"


def power_limit(mantissa: DecimalLayout) -> int:
    """The power of ten that a mantissa does not reach."""
    return count_digits(mantissa.before)


def exponent_layout(tokens: Sequence[Token]) -> ExponentLayout:
    """The layout of a section with an exponent.

    Raises:
        FormatError: a place for a digit is missing before or behind the `E`.
    """
    split = next(index for index, token in enumerate(tokens) if token.mark is Mark.EXPONENT)
    mantissa, power = tokens[:split], settle_commas(tokens[split + 1 :])[0]
    if not count_digits(mantissa) or not count_digits(power):
        raise FormatError("an exponent has digits before and behind its E")
    return ExponentLayout(decimal_layout(mantissa), tokens[split].text, tuple(power))
