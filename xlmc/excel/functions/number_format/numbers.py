"""Numbers with a point, an exponent or a fraction: `#,##0.00`, `0.0%`, `##0.0E+0`, `# ?/?`, `# ?/8`."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from decimal import ROUND_HALF_UP, Context, Decimal
from typing import Final

from xlmc.excel.functions.number_format.placeholders import (
    Written,
    count_digits,
    fill_decimals,
    fill_whole,
    read_commas,
)
from xlmc.excel.functions.number_format.tokens import FormatError, Mark, Token
from xlmc.excel.functions.number_text import round_to_15_digits

__all__ = ["decimal_layout", "exponent_layout", "fraction_layout"]

_WIDE: Final = Context(prec=1000, rounding=ROUND_HALF_UP)
"""Enough for any number with as many decimals as a format can ask for."""


@dataclass(frozen=True, slots=True)
class _DecimalLayout:
    """Digit placeholders, with a point or without.

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
        number = round_to_15_digits(size).scaleb(self.scale).quantize(Decimal(1).scaleb(-self.decimals), context=_WIDE)
        whole, _, decimals = f"{number:f}".partition(".")
        return self.fill(whole.lstrip("0"), decimals), not number

    def fill(self, whole: str, decimals: str) -> str:
        """Put the digits into their placeholders; whole digits stand before the point even if no placeholder does."""
        text = fill_whole(self.before, whole, self.grouped)
        if self.after is None:
            return text
        return f"{text}{'' if count_digits(self.before) else whole}.{fill_decimals(self.after, decimals)}"


def decimal_layout(tokens: Sequence[Token]) -> _DecimalLayout:
    """Return the layout of a section with digit placeholders."""
    places, grouped, thousands = read_commas(tokens)
    percents = sum(token.mark is Mark.PERCENT for token in tokens)
    points = [index for index, token in enumerate(places) if token.mark is Mark.POINT]
    split = points[0] if points else len(places)
    after = tuple(places[split + 1 :]) if points else None
    return _DecimalLayout(tuple(places[:split]), after, grouped, 2 * percents - 3 * thousands)


@dataclass(frozen=True, slots=True)
class _ExponentLayout:
    """A mantissa and an exponent, which is a multiple of the count of digit placeholders before the point.

    Attributes:
        mark: `E+` or `E-`, as written; the latter writes no plus.
    """

    mantissa: _DecimalLayout
    mark: str
    power: tuple[Token, ...]

    def write(self, size: float, date1904: bool = False) -> Written:
        number = round_to_15_digits(size)
        if not number:
            zeros = "0" * count_digits(self.mantissa.before)
            return self.mantissa.fill(zeros, "") + self._power(0), False
        step = max(count_digits(self.mantissa.before), 1)
        power = self._step_down(number.adjusted(), step)
        mantissa = self._rounded(number, power)
        if mantissa.adjusted() >= count_digits(self.mantissa.before):
            power += step
            mantissa = self._rounded(number, power)
        whole, _, decimals = f"{mantissa:f}".partition(".")
        return self.mantissa.fill(whole.lstrip("0"), decimals) + self._power(power), False

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


def exponent_layout(tokens: Sequence[Token]) -> _ExponentLayout:
    """Return the layout of a section with an exponent.

    Raises:
        FormatError: there is no digit placeholder before or behind the `E`.
    """
    split = next(index for index, token in enumerate(tokens) if token.mark is Mark.EXPONENT)
    mantissa, power = tokens[:split], read_commas(tokens[split + 1 :])[0]
    if not count_digits(mantissa) or not count_digits(power):
        raise FormatError("an exponent has digits before and behind its E")
    return _ExponentLayout(decimal_layout(mantissa), tokens[split].text, tuple(power))


_EXACT: Final = 5e-10
"""A remainder below this ends the continued fraction."""

_MOST_DIGITS: Final = 7
"""The most digits that Excel gives to a denominator."""


@dataclass(frozen=True, slots=True)
class _FractionLayout:
    """A fraction, after a whole number or without one.

    Attributes:
        whole: the tokens up to the last digit of the whole number; None without one.
        gap: what stands between the whole number and the fraction.
        stroke: what stands between the numerator and the denominator.
        fixed: the denominator, where the format gives it.
        rest: what stands behind the denominator.
    """

    whole: tuple[Token, ...] | None
    grouped: bool
    gap: str
    numerator: tuple[Token, ...]
    stroke: str
    denominator: tuple[Token, ...]
    fixed: int | None
    rest: tuple[Token, ...]

    def write(self, size: float, date1904: bool = False) -> Written:
        n, d = self._approximate(size)
        if self.whole is None:
            return f"{self.gap}{self._fraction(n, d)}{self._rest()}", False
        units, n = divmod(n, d)
        return f"{self._mixed(self.whole, units, n, d)}{self._rest()}", False

    def _approximate(self, size: float) -> tuple[int, int]:
        if self.fixed is None:
            return approximate(size, 10 ** min(count_digits(self.denominator), _MOST_DIGITS) - 1)
        units = math.floor(size)
        return units * self.fixed + math.floor((size - units) * self.fixed + 0.5), self.fixed

    def _mixed(self, whole: tuple[Token, ...], units: int, n: int, d: int) -> str:
        if n == 0 and "0" not in _placeholders(self.numerator):
            return self._whole(whole, str(units)) + self._zero_fraction(whole)
        if units == 0 and n > 0 and "0" not in _placeholders(whole):
            return f"{self._whole(whole, '')}{self._gap_without_whole(whole)}{self._fraction(n, d)}"
        if units == 0 and n == 0 and not set(_placeholders(whole)) & {"0", "?"}:
            return f"{self._whole(whole, '')}{self._gap_without_whole(whole)}{self._fraction(n, d)}"
        return f"{self._whole(whole, str(units))}{self.gap}{self._fraction(n, d)}"

    def _whole(self, whole: tuple[Token, ...], digits: str) -> str:
        return fill_whole(whole, digits, self.grouped)

    def _fraction(self, n: int, d: int) -> str:
        return f"{fill_whole(self.numerator, str(n))}{self.stroke}{self._denominator(d)}"

    def _denominator(self, d: int) -> str:
        """Write the digits, then what unused placeholders write; or zeros before the digits if the format begins with
        0.
        """
        placeholders = _placeholders(self.denominator)
        digits = str(d)
        if placeholders[:1] == "0":
            return digits.zfill(len(placeholders))
        return digits + placeholders[len(digits) :].replace("?", " ").replace("#", "")

    def _zero_fraction(self, whole: tuple[Token, ...]) -> str:
        """Return what stands for a fraction of 0: spaces where any `?` aligns the number, else nothing."""
        width = len(self.gap) + len(self.numerator) + len(self.stroke) + len(self.denominator)
        aligned = "?" in _placeholders(whole) + _placeholders(self.numerator) + _placeholders(self.denominator)
        return " " * width if aligned else ""

    def _gap_without_whole(self, whole: tuple[Token, ...]) -> str:
        """Return what stands for the gap behind a whole number that is left out."""
        return " " * len(self.gap) if "?" in _placeholders(whole) + _placeholders(self.numerator) else ""

    def _rest(self) -> str:
        return fill_whole(self.rest, "")


def _placeholders(tokens: Sequence[Token]) -> str:
    return "".join(token.text for token in tokens if _is_placeholder(token))


def approximate(x: float, largest: int) -> tuple[int, int]:
    """Numerator and denominator, at most `largest`: the last convergent of the continued fraction of `x`.

    Excel takes convergents only, and in doubles: 0.3 in ninths and less is 2/7, 1.3 is 4/3.
    """
    n, d, n_before, d_before = 1, 0, 0, 1
    remainder = x
    while True:
        term = math.floor(remainder)
        n, d, n_before, d_before = term * n + n_before, term * d + d_before, n, d
        if d > largest:
            return n_before, d_before
        if remainder - term < _EXACT:
            return n, d
        remainder = 1 / (remainder - term)


def fraction_layout(tokens: Sequence[Token]) -> _FractionLayout:
    """Return the layout of a section with digit placeholders and a stroke.

    Raises:
        FormatError: the numerator or the denominator is missing.
    """
    slash = next(index for index, token in enumerate(tokens) if token.mark is Mark.SLASH)
    top = _end_of_digits(tokens[:slash])
    start = _start_of_run(tokens[:top])
    whole_end = _end_of_digits(tokens[:start])
    bottom, rest = _denominator(tokens[slash + 1 :])
    between = tokens[slash + 1 : len(tokens) - len(bottom) - len(rest)]
    whole, grouped, _ = read_commas(tokens[:whole_end])
    if start == top or not bottom:
        raise FormatError("a fraction has a numerator and a denominator")
    return _FractionLayout(
        whole=tuple(whole) if whole_end else None,
        grouped=grouped,
        gap=_text(tokens[whole_end:start]),
        numerator=tuple(tokens[start:top]),
        stroke=f"{_text(tokens[top:slash])}/{_text(between)}",
        denominator=tuple(bottom),
        fixed=int(_placeholders(bottom)) if bottom[0].mark is Mark.NUMERAL else None,
        rest=tuple(rest),
    )


def _end_of_digits(tokens: Sequence[Token]) -> int:
    """Return the position at which the last digit placeholder ends; 0 without one."""
    return max((index + 1 for index, token in enumerate(tokens) if token.mark is Mark.DIGIT), default=0)


def _start_of_run(tokens: Sequence[Token]) -> int:
    """Return the position at which the digit placeholders at the end start."""
    start = len(tokens)
    while start and tokens[start - 1].mark is Mark.DIGIT:
        start -= 1
    return start


def _denominator(tokens: Sequence[Token]) -> tuple[list[Token], list[Token]]:
    """Return the first run of digit placeholders, or the first number, and what stands behind it."""
    start = next((index for index, token in enumerate(tokens) if _is_placeholder(token)), len(tokens))
    fixed = start < len(tokens) and tokens[start].mark is Mark.NUMERAL
    end = start
    wanted = "0123456789" if fixed else "0#?"
    while end < len(tokens) and _is_placeholder(tokens[end]) and tokens[end].text in wanted:
        end += 1
    return list(tokens[start:end]), list(tokens[end:])


def _is_placeholder(token: Token) -> bool:
    return token.mark in (Mark.DIGIT, Mark.NUMERAL)


def _text(tokens: Sequence[Token]) -> str:
    return "".join(token.text for token in tokens)
