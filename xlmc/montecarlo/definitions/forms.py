"""How the numbers of a forecast are written: a number, a percentage, an amount of money, a date, as its cell shows it.

Numbers stay as they are in the cell, a percentage as a share and a date as a serial number; a `Form` writes them.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final

from xlmc.errors import FormulaError
from xlmc.montecarlo.definitions.stating import Kind
from xlmc.montecarlo.number_text import (
    MOST_DIGITS,
    decimals_of,
    exact_digits,
    exact_text,
    fixed_text,
    format_estimate,
    is_far,
    number_text,
    signs,
    two_digit_exponent,
)

if TYPE_CHECKING:
    from xlmc.montecarlo.statistics import Estimate

__all__ = ["PLAIN", "Form", "kind_of_format", "span_text"]

_QUOTED: Final = re.compile(r'"([^"]*)"|\\(.)|\[\$([^\]-]*)(?:-[^\]]*)?\]|\[[^\]]*\]|_.|\*.')
_DIGITS: Final = re.compile(r"[#0?][#0?,.\s]*")
_DECIMALS: Final = re.compile(r"[0#?]\.(0+)")
_SHORTENED: Final = re.compile(r"[0#?],+(?![0#?,])")
"""Commas behind the last digit: the cell shows thousands or millions."""
_SIGNS: Final = "$€£¥₹₽₩₺₴฿₫₱₪₦"
_CODES: Final = re.compile(
    r"\b(USD|EUR|GBP|JPY|CHF|CAD|AUD|NZD|CNY|INR|SEK|NOK|DKK|PLN|CZK|HUF|BRL|MXN|ZAR)\b|kr|zł|Kč"
)
_CODES_OF: Final = {"$": "USD CAD AUD NZD MXN", "€": "EUR", "£": "GBP", "¥": "JPY CNY", "₹": "INR"}
"""Sign of money -> the codes of the currencies that it may stand for."""
_MOMENT: Final = re.compile(r"[ymdhs]", re.IGNORECASE)
_DAY: Final = "yyyy-mm-dd"
_DAY_AND_TIME: Final = "yyyy-mm-dd hh:mm"
_SECONDS_A_DAY: Final = 86_400
_TICK: Final = 6
"""Decimals of a number beside an axis; one that needs more has a power of ten."""
_OF_DAYS: Final = {"below": "before", "above": "after", "at most": "not after", "at least": "not before"}
_IN_PERCENT: Final = (Kind.PERCENT, Kind.YES_NO)
_SECONDS: Final = (1, 2, 5, 10, 30, 60, 120, 300, 600, 1800, 3600, 7200, 21_600, 43_200)
_DAYS: Final = (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 5000, 10_000)
_STEPS: Final = tuple(map(float, [*_SECONDS, *(days * _SECONDS_A_DAY for days in _DAYS)]))
"""Steps in which dates and times are stated, in seconds."""
_UNITS: Final = ((1.0, 1.0, "days"), (1 / 24, 24.0, "h"), (1 / 1440, 1440.0, "min"), (0.0, 86400.0, "s"))
"""From so many days on, a span is written in units of which a day has so many."""


def kind_of_format(code: str) -> Kind | None:
    """Return what a number format says that the numbers are; None where it does not say.

    >>> [kind_of_format(code) for code in ("0.0%", '"$"#,##0', "d-mmm-yy", '0.0" mph"', "General")]
    [<Kind.PERCENT: 'percent'>, <Kind.CURRENCY: 'currency'>, <Kind.DATE: 'date or time'>, None, None]
    """
    first = code.partition(";")[0]
    bare = _QUOTED.sub("", first)
    if bare.strip().casefold() in ("", "general", "standard", "@"):
        return None
    if "%" in bare:
        return Kind.PERCENT
    if any(_is_money(affix) for affix in _affixes(first)):
        return Kind.CURRENCY
    elapsed = re.search(r"\[[hms]+\]", first, re.IGNORECASE)
    return Kind.DATE if elapsed or (_MOMENT.search(bare) and not _DIGITS.match(bare.strip())) else None


def _is_money(affix: str) -> bool:
    return any(sign in affix for sign in _SIGNS) or bool(_CODES.search(affix))


def _money_in(affix: str) -> str:
    """Return the sign of money in what stands beside a number, with the space towards the number."""
    sign = next((each for each in _SIGNS if each in affix), None)
    match = re.search(rf"\s*{re.escape(sign)}\s*" if sign else rf"\s*(?:{_CODES.pattern})\s*", affix)
    return match[0] if match else ""


def _are_one_currency(first: str, second: str) -> bool:
    """Whether two texts name money alike: by one sign or code, or one by a sign and the other by a code."""
    for one, other in ((first, second), (second, first)):
        named = [sign for sign in _SIGNS if sign in one] + [match[0] for match in _CODES.finditer(one)]
        codes = {code for name in named for code in (name, *_CODES_OF.get(name, "").split())}
        if any(code in other for code in codes):
            return True
    return False


def _affixes(first: str) -> tuple[str, str]:
    """Return what a section writes before and after the digits, as plain text."""
    marked = _QUOTED.sub(lambda match: "".join(part or "" for part in match.groups()), first)
    result = _DIGITS.search(marked)
    if result is None:
        return "", ""
    digits = result[0].rstrip()
    return marked[: result.start()].lstrip("("), marked[result.start() + len(digits) :].rstrip(")")


@dataclass(frozen=True, slots=True)
class Form:
    """The form of one forecast's numbers.

    Attributes:
        kind: what the numbers are.
        code: the number format of the cell.
        report_to: the resolution at which they are stated; None where their error alone decides.
        date1904: whether days are counted from 1904.
        bare: whether amounts of money stand without their sign, because the units beside them say it.
    """

    kind: Kind = Kind.NUMBER
    code: str = "General"
    report_to: float | None = None
    date1904: bool = False
    bare: bool = False

    def beside_units(self, units: str) -> Form:
        """Return the form of numbers that stand beside their units, so that a currency is said once.

        >>> form = Form(Kind.CURRENCY, '#,##0 "€"')
        >>> [form.beside_units(units).number(4660.0) for units in ("", "EUR", "USD", "in thousands")]
        ['4,660 €', '4,660', '4,660 €', '4,660 €']
        """
        affixes = self.affixes
        if self.kind is not Kind.CURRENCY or any(_money_in(each).strip() != each.strip() for each in affixes):
            return self
        return replace(self, bare=True) if _are_one_currency("".join(affixes), units) else self

    @property
    def factor(self) -> float:
        """What a number is multiplied by before it is written: 100 for percentages and for shares of yes."""
        return 100.0 if self.kind in _IN_PERCENT else 1.0

    @property
    def affixes(self) -> tuple[str, str]:
        """What is written before and after each number."""
        if self.kind in _IN_PERCENT:
            return "", " %"
        if self.kind is not Kind.CURRENCY or self.bare:
            return "", ""
        first = self.code.partition(";")[0]
        before, after = _affixes(first)
        if not (_is_money(before) or _is_money(after)):
            return "", ""
        # `#,##0,,"M €"` shows millions; the numbers here are whole ones, so that only the sign of money is true of them
        return (_money_in(before), _money_in(after)) if _SHORTENED.search(_QUOTED.sub("", first)) else (before, after)

    def side(self, words: str) -> str:
        """Say `below`, `above`, `at most` or `at least` as one does of such numbers: of days `before`, `after`."""
        return _OF_DAYS[words] if self.kind is Kind.DATE and self.shows != "span" else words

    @property
    def axis(self) -> tuple[object, ...]:
        """What forms have in common whose numbers fit one axis: days and spans of time do not."""
        is_date = self.kind is Kind.DATE
        return is_date, is_date and self.shows == "span", self.factor, self.affixes

    def number(self, value: float, decimals: int | None = None, *, typed: bool = False) -> str:
        """Write a number without an error, to so many decimals of what is written; by default with all that it has, up
        to six digits or more, and with all that a person has `typed`.
        """
        if not math.isfinite(value):
            return ""
        if self.kind is Kind.DATE:
            return self._moment(value)
        scaled = self._scaled(value)
        if decimals is None:
            text = self._whole_coins(exact_text(abs(scaled), typed=typed))
        elif scaled and decimals + two_digit_exponent(scaled) >= MOST_DIGITS:
            text = exact_text(abs(scaled))  # decimals below its last bit say nothing
        elif is_far(scaled):
            text = number_text(abs(scaled), max(decimals + two_digit_exponent(scaled) + 1, 1))
        else:
            text = fixed_text(abs(scaled), decimals)
        return self._signed(text, scaled < 0.0)

    def _whole_coins(self, text: str) -> str:
        """Write an amount of money that has decimals with as many as its cell shows, at least: `1,234.50`."""
        _, point, decimals = text.partition(signs()[1])
        shown = _DECIMALS.search(self.code.partition(";")[0]) if point and self.kind is Kind.CURRENCY else None
        return text if shown is None or "e" in text else text + "0" * (len(shown[1]) - len(decimals))

    def beside(self, value: float, like: Estimate) -> str:
        """Write a number without an error in the digits of another one; in six where its error is not known, either;
        in all of its own where that is an exact one. Beside a number with a power of ten zero has no decimals.
        """
        is_plain = like.error is None or (value == 0.0 and is_far(self._scaled(like.value)))
        return self.rough(value) if is_plain else self.number(value, self._decimals(like))

    def value(self, estimate: Estimate) -> str:
        """Return the number in the digits that its error supports, without the error."""
        if math.isnan(estimate.value):
            return ""
        return self.number(estimate.value, self._decimals(estimate)) if estimate.error else self.rough(estimate.value)

    def rough(self, value: float) -> str:
        """Write a number whose error is not known, in six digits."""
        if self.kind is Kind.DATE or not math.isfinite(value):
            return self.number(value)
        return self._signed(number_text(abs(self._scaled(value))), value < 0.0)

    def estimate(self, result: Estimate, decimals: int | None = None) -> str:
        """`11.799 ± 0.013`, `$48,210 ± 870`, `5.44 ± 0.32 %`, `2026-03-01 ± 1.2 days`; empty where there is no number.

        Args:
            result: the number and its error.
            decimals: of both; by default those of the error in two digits.
        """
        if math.isnan(result.value):
            return ""
        if self.kind is Kind.DATE:
            error = "" if not result.error else f" ± {span_text(result.error)}"
            return f"{self._moment(result.value)}{error}"
        if result.error is None:
            return self.rough(result.value) if decimals is None else self.number(result.value, decimals)
        if result.error == 0.0:
            return self.number(result.value)
        scaled = self._scaled(result.value)
        text = format_estimate(abs(scaled), abs(self._scaled(result.error)), decimals)
        return self._signed(text, scaled < 0.0)

    def ends(self, low: Estimate, high: Estimate, like: Estimate) -> str:
        """`172.53 ± 0.70 to 243.16 ± 0.97`, both to the same decimal; ends without an error as `like`."""
        decimals = self.decimals_of_both(low, high)
        if decimals is None and not (low.error or high.error) and None not in (low.error, high.error):
            decimals = self._decimals_of_exact(low.value, high.value)
        texts = []
        for end in (low, high):
            if end.error or self.kind is Kind.DATE:
                texts.append(self.estimate(end, decimals))
            elif decimals is not None:
                texts.append(self.number(end.value, decimals))
            else:
                texts.append(self.estimate(end) if end.error == 0.0 else self.beside(end.value, like))
        return " to ".join(texts)

    def _decimals_of_exact(self, *values: float) -> int | None:
        """Return the decimals of two numbers without an error: all that they have, or six digits of the larger one."""
        scaled = [self._scaled(value) for value in values]
        if self.kind is Kind.DATE or not all(map(math.isfinite, scaled)) or any(map(is_far, scaled)):
            return None
        exact = [exact_text(value).partition(signs()[1])[2] for value in scaled if exact_digits(value)]
        needed = max(map(len, exact), default=0)
        if len(exact) == len(scaled):
            return needed
        return max(needed, 5 - two_digit_exponent(max(map(abs, scaled))), 0)

    def decimals_of_both(self, *estimates: Estimate) -> int | None:
        """Return the decimals of two numbers that stand beside each other: those of the larger error."""
        known = [decimals_of(self._scaled(each.error)) for each in estimates if each.error]
        if any(is_far(self._scaled(each.value)) for each in estimates):
            return None
        return min((each for each in known if each is not None), default=None)

    def spread(self, estimate: Estimate) -> str:
        """Write a standard deviation or a difference, with its error: of dates a span of time."""
        if self.kind is not Kind.DATE:
            return self.estimate(estimate)
        if not estimate.value and not estimate.error:
            return f"0 {'s' if self.shows == 'span' else 'days'}"
        return (
            "" if math.isnan(estimate.value) else span_text(estimate.value, estimate.error, days=self.shows != "span")
        )

    def width(self, value: float) -> str:
        """Return the width of a bar: of dates a span of time."""
        return (
            self.number(value)
            if self.kind is not Kind.DATE
            else span_text(value, exact=True, days=self.shows != "span")
        )

    def tick(self, value: float, decimals: int) -> str:
        """Write a number beside an axis, to so many decimals of the number itself."""
        if self.kind is Kind.DATE:
            return self._moment(value)
        shift, scaled = 2 if self.kind in _IN_PERCENT else 0, abs(self._scaled(value))
        many = is_far(scaled) or decimals > _TICK
        text = number_text(scaled) if many else fixed_text(scaled, max(decimals - shift, 0))
        return self._signed(text, value < 0.0)

    def rounded_width(self, width: float) -> float:
        """Return the width of bars near another one, in which dates and times are round; of other numbers the same."""
        if self.kind is not Kind.DATE:
            return width
        return min(_STEPS, key=lambda each: abs(math.log(each / (width * _SECONDS_A_DAY)))) / _SECONDS_A_DAY

    def step(self, error: float) -> float | None:
        """Return the step in which a number with this error is stated: of whole numbers 1, of dates and times a unit
        that their format shows, or a longer one; None where powers of ten will do.
        """
        if self.kind is Kind.WHOLE:
            return 1.0 if error < 2.0 else None
        if self.kind is not Kind.DATE:
            return None
        code = self._bare_moment_code
        least = 1.0 if "s" in code else float(_SECONDS_A_DAY)
        if "h" in code and "s" not in code:
            least = 60.0 if re.search(r"h\W*m", code) else 3600.0
        wanted = max(least, error * _SECONDS_A_DAY / 2.0)
        return next((each for each in _STEPS if each >= wanted), _STEPS[-1]) / _SECONDS_A_DAY

    def _decimals(self, estimate: Estimate) -> int | None:
        return None if not estimate.error else decimals_of(self._scaled(estimate.error))

    def _scaled(self, value: float) -> float:
        return self.factor * value

    def _signed(self, text: str, negative: bool) -> str:
        before, after = self.affixes
        sign = "-" if negative and any(digit in text.partition(" ")[0] for digit in "123456789") else ""
        return f"{sign}{before}{text}{after}"

    @property
    def epoch(self) -> int:
        """The serial number of 1 January 1970."""
        return 24_107 if self.date1904 else 25_569

    @property
    def shows(self) -> str:
        """What the format shows of a moment: the `day`, the `time` of a day too, or a `span` without a day."""
        code = self._bare_moment_code
        if not re.search(r"[yd]", code):
            return "span"
        return "time" if re.search(r"[hs]", code) else "day"

    @property
    def order(self) -> str:
        """The order in which the format shows year, month and day: `dmy`; `ymd` where it does not show all three."""
        days = re.sub(r"h+\W*m+(?:\W*s+)?|m+\W*s+", "", self._bare_moment_code)
        text = "".join(dict.fromkeys(re.findall(r"[ymd]", days)))
        return text if len(text) == 3 else "ymd"

    @property
    def moment_code(self) -> str:
        """The format of dates: that of the cell, or ISO's."""
        return self.code if kind_of_format(self.code) is Kind.DATE else _DAY

    @property
    def _bare_moment_code(self) -> str:
        """The format of dates without quoted texts, in small letters; spans such as `[h]` stay."""
        return _QUOTED.sub(lambda match: match[0] if match[0].startswith("[") else "", self.moment_code).casefold()

    def _moment(self, value: float) -> str:
        """Write a date or time, to the second; a number where it is none."""
        from xlmc.excel.functions.number_format import FormatError, UnknownFormat, parse_format  # few books have dates

        seconds = value * _SECONDS_A_DAY
        if not math.isfinite(seconds):
            return number_text(value)
        rounded = round(seconds) / _SECONDS_A_DAY
        for code in (self.moment_code, _DAY_AND_TIME):
            try:
                return parse_format(code).number(rounded, self.date1904)
            except (FormatError, UnknownFormat, FormulaError):
                continue
        return number_text(value)


def span_text(span: float, error: float | None = None, *, exact: bool = False, days: bool = True) -> str:
    """Write a span of time, given in days, in the units that suit it; in hours at most without `days`, as `[h]:mm` has.

    >>> span_text(0.084), span_text(12.31, 0.042), span_text(250.0, exact=True), span_text(2.5, exact=True, days=False)
    ('2.0 h', '12.310 ± 0.042 days', '250 days', '60 h')
    """
    size = max(abs(span), error or 0.0)
    _, factor, unit = next(each for each in _UNITS[not days :] if size >= each[0])
    if error:
        return f"{format_estimate(span * factor, error * factor)} {unit}"
    if exact:
        text = exact_text(span * factor)
        return "1 day" if (text, unit) == ("1", "days") else f"{text} {unit}"
    return f"{fixed_text(span * factor, max(decimals_of(span * factor) or 0, 0))} {unit}"


PLAIN: Final = Form()
"""The form of numbers of which no more is known."""
