"""What stands in a cell of a result sheet: a text or a number, how the number shows, how the cell looks.

Excel's number formats show no more decimals than a standard error supports, as `format_estimate` prints them. A cell
keeps its full number; only what it shows is cut. Excel cannot show a number rounded to tens, so one whose error is
larger than a unit shows its units too, with the error beside it.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, replace

from xlmc.analysis.results.statements.in_words import plain_text
from xlmc.excel.functions.number_format import FormatError, parse_format
from xlmc.montecarlo.definitions.forms import PLAIN, Form
from xlmc.montecarlo.definitions.stating import Kind
from xlmc.montecarlo.number_text import (
    decimals_of,
    exact_text,
    fixed_text,
    fraction,
    number_text,
    percent_format,
    styled_text,
    two_digit_exponent,
)
from xlmc.montecarlo.statistics import Estimate

__all__ = [
    "AT_LEAST",
    "BLANK",
    "LOGICAL",
    "NOISE",
    "NONE",
    "Shown",
    "count",
    "estimate",
    "exact",
    "interval",
    "number_format",
    "paired_format",
    "share",
    "share_format",
    "shown_text",
    "spread_format",
]

NONE = "–"
"""The text shown if there is no number."""

LOGICAL = '"TRUE";"TRUE";"FALSE"'
"""The format of a logical: LibreOffice shows 1 or 0 without it; Excel has its own words and does not heed it."""

NOISE = '"noise";"noise";"noise"'
"""The format of a number that is no more than noise: it shows the word."""

AT_LEAST = '"at least "'
"""What a number format begins with, if the number is a lower bound."""

_COUNT = "#,##0"

_DIGITS = 6
"""Significant digits where no error limits them."""

_ROOM = 9
"""Characters that columns have room for; fewer decimals are shown rather than `###`."""

_FORMAT = re.compile(r"(?P<grouped>#,##)?0(\.(?P<decimals>0+))?(?P<ending>%|E\+00)?")

_WITH_WORDS = re.compile(r'(?:"(?P<before>[^"]*)")?(?P<digits>(?:#,##)?0(?:\.0+)?(?:E\+00)?)(?:"(?P<after>[^"]*)")?')

_POWER = re.compile(r"0(?:\.0+)?E\+00")

_LONGEST = 11
"""Characters of a number that Excel shows in a cell without a format."""

_LARGEST, _SMALLEST = 1e15, 1e-4
"""A number outside these limits is shown with a power of ten."""


@dataclass(frozen=True, slots=True)
class Shown:
    """The content of one cell: a text as it is, also where it begins with `=`; a number; None is an empty cell.

    Attributes:
        look: by default `text` for a text, and `number` for anything else.
        date1904: whether a date counts days from 1904.
        written: its text in outputs that are no sheet, where that is another than the sheet shows.
    """

    value: str | float | None
    format: str = "General"
    look: str = ""
    date1904: bool = False
    written: str = ""

    def __post_init__(self) -> None:
        if not self.look:
            object.__setattr__(self, "look", "text" if isinstance(self.value, str) else "number")
        if self.value == 0.0 and "E+00" in self.format:  # 0, not 0.000E+00
            object.__setattr__(self, "format", _POWER.sub("0", self.format))


BLANK = Shown(None)

_ROUNDING = 1e-14
"""An error of a share from which on it is none of sampling; Excel refuses formats of more than 30 decimals."""


def exact(value: float | None, form: Form = PLAIN, like: Estimate | None = None) -> Shown:
    """Show a number without error, such as a setting, in the digits of an estimate `like` it, if one is given."""
    if like is not None and like.error:
        return Shown(value, paired_format(like, form), date1904=form.date1904)
    return Shown(value, _exact_format(value, form), date1904=form.date1904)


def count(value: int) -> Shown:
    """Trials."""
    return Shown(value, _COUNT)


def estimate(
    result: Estimate,
    look: str = "number",
    error_look: str = "error",
    *,
    like: Estimate | None = None,
    form: Form = PLAIN,
    spread: bool = False,
) -> list[Shown]:
    """Two cells: the value, and its standard error in the same digits; without an error, in those of `like`.

    Args:
        result: the number and its error.
        look: of the value.
        error_look: of the error.
        like: a number beside it.
        form: how the numbers are written.
        spread: whether it is a standard deviation or a difference; of dates it is then a span of time.
    """
    digits = paired_format(like if result.error is None and like is not None else result, form)
    error = _error_format(result, digits, form)
    value = digits
    if spread and form.kind is Kind.DATE:
        value = error = _span_format(result.value, result.error)
    return [Shown(result.value, value, look, form.date1904), _error(result.error, error, error_look)]


def share(result: Estimate, look: str = "") -> list[Shown]:
    """Two cells: a share of trials and its standard error, in percent."""
    digits = share_format(result)
    return [Shown(result.value, digits, look), _error(result.error, digits, "error")]


def interval(result: Estimate, *, percent: bool = False, form: Form = PLAIN, spread: bool = False) -> list[Shown]:
    """Two cells: the ends of the 95 % interval, in the digits of the value."""
    digits = share_format(result) if percent else paired_format(result, form)
    if spread and form.kind is Kind.DATE:
        digits = _span_format(result.value, result.error)
    shown = [replace(_error(end, digits, "error"), date1904=form.date1904) for end in result.interval or (None, None)]
    decimals = None if percent or form.kind is Kind.DATE else _paired_decimals(result, form)
    if decimals is None or decimals >= 0:
        return shown
    return [replace(e, written=form.number(e.value, decimals)) if isinstance(e.value, float) else e for e in shown]


def _error(value: float | None, digits: str, look: str) -> Shown:
    return Shown(NONE if value is None else value, digits, look)


def paired_format(estimate: Estimate, form: Form = PLAIN) -> str:
    """Return the format of a value whose error stands in a cell of its own: two digits of the error."""
    if form.kind is Kind.DATE:
        return form.moment_code
    if estimate.error == 0.0:
        return _exact_format(estimate.value, form)
    return _in_form(_format(form.factor * estimate.value, _paired_decimals(estimate, form)), form)


def _exact_format(value: float | None, form: Form) -> str:
    if form.kind is Kind.DATE:
        return form.moment_code
    if form.factor == 1.0 and not any(form.affixes):
        return "General" if value is None or not math.isfinite(value) else number_format(value)
    digits = exact_text(form.factor * (value or 0.0)).partition(".")[2]
    return _in_form("#,##0" + fraction(len(digits)), form)


def _in_form(digits: str, form: Form) -> str:
    """Return the format of a number with what stands before and after it: a sign of money, or a percent sign."""
    before, after = form.affixes
    if digits == "General" or not (before or after):
        return digits
    if form.factor != 1.0:
        return f"{digits.replace(_COUNT, '0')}%"
    return "".join((f'"{before}"' if before else "", digits, f'"{after}"' if after else ""))


def _error_format(result: Estimate, digits: str, form: Form = PLAIN) -> str:
    """Return the format of the error beside a value; digits of its own where those of the value would show 0."""
    if form.kind is Kind.DATE:
        return _span_format(result.error or 0.0, result.error)
    decimals = _paired_decimals(result, form)
    if result.error is None or decimals is None or "E" in digits or form.factor != 1.0:
        return digits
    bare = digits.split('"')[2] if digits.startswith('"') else digits.split('"')[0]
    enough = len(bare.partition(".")[2]) >= decimals - 1
    return digits if enough else _in_form(_format(result.error, decimals), form)


def _span_format(days: float, error: float | None) -> str:
    """Return the format of a span in days: days in the digits of the error, or hours where it is up to a day."""
    decimals = decimals_of(error or days)
    if not math.isfinite(days) or 0.0 <= days < 1.0 or decimals is None:
        return "[h]:mm:ss"  # of a span below 0 Excel shows ####
    return f'#,##0{fraction(max(decimals, 0))}" days"'


def share_format(estimate: Estimate) -> str:
    """`paired_format` for a share, in percent."""
    decimals = _paired_decimals(estimate) if (estimate.error or 0.0) > _ROUNDING else None
    return percent_format((4 if decimals is None else decimals) - 2)


def spread_format(spread: float, form: Form = PLAIN) -> str:
    """Return the format of single trials: four digits of their spread."""
    if form.kind is Kind.DATE:
        return form.moment_code
    scaled = form.factor * spread
    return _in_form(_format(scaled, 3 - two_digit_exponent(scaled)), form) if _usable(spread) else "General"


def number_format(value: float) -> str:
    """Return the format of a number that stands alone: six digits, or all that it has where these are fewer."""
    if float(value).is_integer():
        return _COUNT if abs(value) < _LARGEST else "General"
    if 0.0 < abs(value) < _SMALLEST:
        return f"0{fraction(len(f'{value:.12g}'.partition('e')[0].lstrip('-').partition('.')[2]))}E+00"
    return "General" if len(repr(value)) <= _DIGITS + 1 else _format(value, None)


def _paired_decimals(estimate: Estimate, form: Form = PLAIN) -> int | None:
    return decimals_of(None if estimate.error is None else form.factor * estimate.error)


def _format(value: float, decimals: int | None) -> str:
    if not math.isfinite(value):
        return "General"
    if decimals is None:
        if value == 0.0:
            return "General"
        decimals = _DIGITS - 1 - two_digit_exponent(value)
    size = max(abs(value), 10.0**-decimals)
    if not _SMALLEST <= size < _LARGEST:
        return "0" + fraction(min(max(decimals + two_digit_exponent(size), 0), 3)) + "E+00"
    room = _ROOM - len(f"{value:,.0f}") - 1
    return "#,##0" + fraction(max(min(decimals, room), 0))


def _usable(number: float) -> bool:
    return number != 0.0 and math.isfinite(number)


def shown_text(shown: Shown) -> str:
    """Return the text that the sheet shows.

    Raises:
        ValueError: there is no such number format.
    """
    value = shown.value
    if value is None:
        return ""
    if isinstance(value, str):
        return value
    if not math.isfinite(value):
        return NONE if math.isnan(value) else "∞" if value > 0 else "−∞"
    return _general(value) if shown.format == "General" else _format_number(value, shown.format, shown.date1904)


def _general(value: float) -> str:
    return exact_text(value) if len(plain_text(value)) <= _LONGEST else number_text(value, 9)


def _format_number(value: float, number_format: str, date1904: bool = False) -> str:
    if number_format == NOISE:
        return "noise"
    if number_format.startswith(AT_LEAST):
        return f"at least {_format_number(value, number_format.removeprefix(AT_LEAST))}"
    match = _FORMAT.fullmatch(number_format)
    if match is None:
        return _text_in_form(value, number_format, date1904)
    decimals, ending = len(match["decimals"] or ""), match["ending"]
    if ending == "E+00":
        return styled_text(value, f".{decimals}e") if value else "0"
    if ending == "%":
        return f"{fixed_text(100.0 * value, decimals)} %"
    return (
        fixed_text(value, decimals) if match["grouped"] else styled_text(round(value, decimals) + 0.0, f".{decimals}f")
    )


def _text_in_form(value: float, number_format: str, date1904: bool) -> str:
    """Write a date, a span of time, an amount of money or a number with words, as the format says.

    Raises:
        ValueError: the format does not write a number.
    """
    match = _WITH_WORDS.fullmatch(number_format)
    if match is not None:
        text = _format_number(abs(value), match["digits"])
        sign = "-" if value < 0.0 and any(digit in text for digit in "123456789") else ""
        return f"{sign}{match['before'] or ''}{text}{match['after'] or ''}"
    try:
        shown = parse_format(number_format)
    except FormatError as error:
        raise ValueError(f"no number format of a result sheet: {number_format!r}") from error
    try:
        return shown.number(value, date1904)
    except FormatError:  # before the first day, or after the last: Excel shows ####
        return number_text(value)
