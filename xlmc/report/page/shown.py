"""A cell of a result sheet as text: the number formats that `xlmc.report.number_format` makes, read by us."""

from __future__ import annotations

import math
import re

from xlmc.report.number_format import NOISE
from xlmc.report.page.element import Html, element
from xlmc.report.sheets.cells import NONE, Shown
from xlmc.report.summary import estimate_text, share_text
from xlmc.results.record.wording import number_text
from xlmc.statistics import Estimate

__all__ = ["estimate_html", "number", "share_html", "shown_html", "shown_text"]

_FORMAT = re.compile(r"(?P<grouped>#,##)?0(\.(?P<decimals>0+))?(?P<ending>%|E\+00)?")
_LONGEST = 11
"""Characters of a number that Excel shows in a cell without a format."""


def shown_text(shown: Shown) -> str:
    """What the sheet shows.

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
    return _general(value) if shown.format == "General" else _formatted(value, shown.format)


def shown_html(shown: Shown) -> Html:
    """The same; a number carries its full value with it."""
    if isinstance(shown.value, str) or shown.value is None or not math.isfinite(shown.value):
        return element("span", shown_text(shown))
    return number(shown.value, shown_text(shown))


def number(value: float, shown: str) -> Html:
    """A number as it is shown, with its full value for whoever reads the page with a program."""
    return element("data", shown, value=number_text(value))


def estimate_html(found: Estimate) -> Html:
    """`11.799 ± 0.013` with the full value; a dash where there is no number."""
    return number(found.value, estimate_text(found)) if math.isfinite(found.value) else element("span", NONE)


def share_html(found: Estimate) -> Html:
    """`12.3 ± 0.5 %`, likewise."""
    return number(found.value, share_text(found)) if math.isfinite(found.value) else element("span", NONE)


def _general(value: float) -> str:
    text = number_text(value)
    return text if len(text) <= _LONGEST else f"{value:.9g}"


def _formatted(value: float, number_format: str) -> str:
    if number_format == NOISE:
        return "noise"
    found = _FORMAT.fullmatch(number_format)
    if found is None:
        raise ValueError(f"no number format of a result sheet: {number_format!r}")
    decimals, ending = len(found["decimals"] or ""), found["ending"]
    if ending == "E+00":
        return f"{value:.{decimals}e}"
    if ending == "%":
        return f"{_rounded(100.0 * value, decimals):.{decimals}f} %"
    value = _rounded(value, decimals)
    return f"{value:,.{decimals}f}" if found["grouped"] else f"{value:.{decimals}f}"


def _rounded(value: float, decimals: int) -> float:
    return round(value, decimals) + 0.0  # no negative zero
