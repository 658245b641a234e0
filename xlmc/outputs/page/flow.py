"""What the result sheets say, on the page: their writers write onto a `Flow` as they do onto a sheet.

Rows, columns, widths and heights mean nothing here: sections, tables and paragraphs follow each other. Numbers look as
in Excel, by the number formats that `xlmc.outputs.sheets.cells` makes.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Sequence
from typing import Any

from xlmc.analysis.results.statements.in_words import number_text
from xlmc.montecarlo.statistics import Estimate
from xlmc.outputs.page.element import Html, element, join
from xlmc.outputs.sheets.cells import AT_LEAST, NOISE, NONE, Shown
from xlmc.outputs.sheets.page import Page
from xlmc.outputs.summary import estimate_text, share_text

__all__ = ["Flow", "estimate_html", "number", "share_html", "shown_html", "shown_text"]

_HEADER = "header"

_NUMBERS = frozenset({"number", "answer", "error", "second number", "second error", "moved", "trial"})

_FORMAT = re.compile(r"(?P<grouped>#,##)?0(\.(?P<decimals>0+))?(?P<ending>%|E\+00)?")

_LONGEST = 11
"""Characters of a number that Excel shows in a cell without a format."""


class Flow(Page):
    """A result sheet as HTML, from the top down."""

    def __init__(self) -> None:
        self.row = 0
        self.sheet = _Nothing()  # type: ignore[assignment]  # takes every call, and does nothing
        self._found: list[Html] = []
        self._open: list[Sequence[Shown]] = []

    @property
    def html(self) -> Html:
        """All that was written so far."""
        self._close()
        return join(self._found)

    def put(self, row: int, column: int, shown: Shown) -> None:
        """Write a single cell, which becomes a paragraph."""
        self.wide(str(shown.value or ""), shown.look, column, column)

    def line(
        self, cells: Sequence[Shown], starts: Iterable[int] | None = None, last: int | None = None, *, fit: bool = True
    ) -> None:
        """Write a row of the table that is being written, or the first of another."""
        if self._open and (len(self._open[-1]) != len(cells) or _heads(cells)):
            self._close()
        self._open.append(list(cells))
        self.row += 1

    def wide(self, value: str, look: str, last: int, first: int = 0) -> None:
        """Write a paragraph."""
        self._add(element("p", value, class_=look))

    def title(self, value: str, below: str, column: int = 0) -> None:
        """Write the heading of the whole, and the line below it."""
        self._add(element("h2", value))
        self._add(element("p", below, class_="subtitle"))

    def heading(self, value: str, column: int = 0) -> None:
        """Write the heading of a section."""
        self._add(element("h3", value))

    def set_up_printing(self, name: str, **options: Any) -> None:
        """Do nothing: the page has a print style of its own."""

    def _add(self, found: Html) -> None:
        self._close()
        self._found.append(found)
        self.row += 1

    def _close(self) -> None:
        if self._open:
            rows, self._open = self._open, []
            headers = [str(shown.value or "") for shown in rows[0]] if _heads(rows[0]) else []
            self._found.append(_table(headers, rows[1:] if headers else rows))


def _heads(cells: Sequence[Shown]) -> bool:
    return cells[0].look.startswith(_HEADER)


def _table(headers: Sequence[str], rows: Sequence[Sequence[Shown]]) -> Html:
    """A table of a sheet's cells, which scrolls where it is wider than the page."""
    numbers = {index for row in rows for index, shown in enumerate(row) if shown.look in _NUMBERS}
    heads = (_head(text, index in numbers) for index, text in enumerate(headers))
    body = [element("tr", *(_cell(shown, index) for index, shown in enumerate(row))) for row in rows]
    parts = [element("thead", element("tr", *heads))] if headers else []
    return element("div", element("table", *parts, element("tbody", *body)), class_="wide-table")


def _head(text: str, right: bool) -> Html:
    if not text:
        return element("td")
    return element("th", text, scope="col", class_="number" if right else None)


def _cell(shown: Shown, index: int) -> Html:
    if index == 0 and isinstance(shown.value, str):
        return element("th", shown.value, scope="row")
    is_number = shown.look in _NUMBERS
    return element("td", shown_html(shown), class_=shown.look if is_number else None)


class _Nothing:
    """Stands for the worksheet; what only a worksheet has (widths, heights, panes) is ignored."""

    def __getattr__(self, name: str) -> Any:
        return lambda *args, **options: None


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
    return _general(value) if shown.format == "General" else _format_number(value, shown.format)


def shown_html(shown: Shown) -> Html:
    """What the sheet shows, as HTML; a number carries its full value with it."""
    if isinstance(shown.value, str) or shown.value is None or not math.isfinite(shown.value):
        return element("span", shown_text(shown))
    return number(shown.value, shown_text(shown))


def number(value: float, shown: str) -> Html:
    """A number as it is shown, with its full value for programs that read the page."""
    return element("data", shown, value=number_text(value))


def estimate_html(found: Estimate) -> Html:
    """`11.799 ± 0.013` with the full value; a dash where there is no number."""
    return number(found.value, estimate_text(found)) if math.isfinite(found.value) else element("span", NONE)


def share_html(found: Estimate) -> Html:
    """`12.3 ± 0.5 %` with the full value; a dash where there is no number."""
    return number(found.value, share_text(found)) if math.isfinite(found.value) else element("span", NONE)


def _general(value: float) -> str:
    text = number_text(value)
    return text if len(text) <= _LONGEST else f"{value:.9g}"


def _format_number(value: float, number_format: str) -> str:
    if number_format == NOISE:
        return "noise"
    if number_format.startswith(AT_LEAST):
        return f"at least {_format_number(value, number_format.removeprefix(AT_LEAST))}"
    found = _FORMAT.fullmatch(number_format)
    if found is None:
        raise ValueError(f"no number format of a result sheet: {number_format!r}")
    decimals, ending = len(found["decimals"] or ""), found["ending"]
    if ending == "E+00":
        return f"{value:.{decimals}e}"
    if ending == "%":
        return f"{_round(100.0 * value, decimals):.{decimals}f} %"
    value = _round(value, decimals)
    return f"{value:,.{decimals}f}" if found["grouped"] else f"{value:.{decimals}f}"


def _round(value: float, decimals: int) -> float:
    return round(value, decimals) + 0.0  # no negative zero
