"""Blocks as HTML, for pages and notebooks. A number carries its full value with it, for programs that read the page."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterable, Iterator

from xlmc.analysis.results.statements.in_words import plain_text
from xlmc.montecarlo.statistics import Estimate
from xlmc.outputs.document.cells import BLANK, NONE, Shown, shown_text
from xlmc.outputs.document.drawings import FONT, drawn
from xlmc.outputs.document.element import EMPTY, Html, element, join
from xlmc.outputs.document.measured import HEADS, Measured
from xlmc.outputs.document.parts import (
    NUMBERS,
    Block,
    Bullets,
    Chart,
    Code,
    Content,
    Drawing,
    Figure,
    Heading,
    Paragraph,
    Picture,
    Table,
)
from xlmc.outputs.summary import estimate_text, share_text

__all__ = ["blocks_html", "cell_html", "estimate_html", "number", "picture_html", "share_html", "shown_html"]

_TEXT_WIDTH = 160.0
"""Millimetres up to which a picture is as wide as the text of a page."""
_LOOKS = {"text": None, "small": "remark"}
_CLASSES = {"answer": "number wraps", "range": "number wraps range", "moved": "number moved"}
"""Of numbers that may have their error in a line of its own, where a table has no room beside them."""


def blocks_html(blocks: Iterable[Block]) -> Html:
    """Return the blocks as HTML; a heading of the first level is the page's second."""
    return join([_html(block) for block in blocks])


def _html(block: Block) -> Html:
    match block:
        case Heading(text, level):
            return element(f"h{level + 1}", text)
        case Paragraph(text, look, phrases):
            parts = [element("bdi", each.text) if each.is_name else each.text for each in phrases] or [text]
            return element("p", *parts, class_=_LOOKS.get(look, look), role="alert" if look == "warning" else None)
        case Bullets(_, look, leads):
            items = (element("li", *_led(lead, rest)) for lead, rest in block.led)
            return element("ul", *items, class_="statements" if leads else _LOOKS.get(look, look))
        case Code(text):
            return element("pre", element("code", text))
        case Figure(picture, caption):
            look = "drawn" if picture.width <= _TEXT_WIDTH else "drawn wide"
            return element("figure", picture_html(picture, look), element("figcaption", caption) if caption else EMPTY)
        case Table():
            return _table(block)


def _led(lead: str, rest: str) -> Iterator[Html | str]:
    """Yield a sentence, with what it begins with in bold."""
    if lead:
        yield element("b", element("bdi", lead))
    yield rest if lead else element("bdi", rest)


def picture_html(picture: Picture, look: str = "drawn") -> Html:
    """Return a picture as SVG in the page itself; its look is `drawn`, or `shape` within a line."""
    shown = drawn(picture) if isinstance(picture, Chart) else picture
    plain = shown.svg.replace(f' font-family="{FONT}"', "")  # the page has a font of its own
    return Html.of_svg(plain, shown.description, look)


def _table(table: Table) -> Html:
    """Return a table, which scrolls where it is wider than the page."""
    at_right = table.at_right
    wide = {index for row in table.rows for index, cell in enumerate(row) if _has_interval(cell)}
    heads = [
        _head(text, index in at_right)
        for index, head in enumerate(table.heads)
        for text in (head, *(HEADS[1:] if index in wide else ()))
    ]
    body = [
        element("tr", *(each for index, cell in enumerate(row) for each in _cells(cell, index, at_right, wide)))
        for row in table.rows
    ]
    inner = element(
        "table",
        element("caption", table.caption) if table.title and table.caption else EMPTY,
        element("thead", element("tr", *heads)) if heads else EMPTY,
        element("tbody", *body),
    )
    caption = table.caption.removesuffix(".")
    title = element("h2", table.title) if table.title else element("h3", caption) if caption else EMPTY
    return title + element("div", inner, class_="wide-table")


def _head(text: str, right: bool) -> Html:
    if not text:
        return element("td")
    return element("th", text, scope="col", class_="number" if right else None)


def _has_interval(cell: Content) -> bool:
    return isinstance(cell, Measured) and cell.interval


def _cells(cell: Content, index: int, at_right: frozenset[int], wide: Collection[int]) -> Iterator[Html]:
    """Yield the cell, and beside a number the ends of its interval, or nothing, in columns that show them."""
    yield _cell(cell, index, at_right)
    if index in wide:
        ends = cell.shown[2:] if isinstance(cell, Measured) and cell.interval else [BLANK] * len(HEADS[1:])
        for end in ends:
            yield _cell(end, index + 1, at_right)


def cell_html(cell: Content) -> Html:
    """Return one cell of a table that is laid out elsewhere."""
    return _cell(cell, 1, frozenset())


def _cell(cell: Content, index: int, at_right: frozenset[int]) -> Html:
    if isinstance(cell, Drawing | Chart):
        return element("td", picture_html(cell, "shape"))
    if isinstance(cell, Measured):
        return element("td", _measured_html(cell), class_=_CLASSES.get(cell.look, "number"))
    if isinstance(cell, Shown):
        if index == 0 and isinstance(cell.value, str):
            return element("th", cell.value, scope="row")
        look = cell.look if cell.look in NUMBERS else "number" if index in at_right else None
        return element("td", shown_html(cell), class_=look)
    if index == 0 and index not in at_right:
        return element("th", cell, scope="row")
    return element("td", *_lines(cell), class_="number" if index in at_right else None)


def _measured_html(cell: Measured) -> Html:
    """Return a number and its error, which carry their full values."""
    if cell.estimate is None or not math.isfinite(cell.estimate.value):
        return element("span", cell.text)
    value, _, error = cell.text.partition(" ± ")
    shown = number(cell.estimate.value, value)
    if not error or cell.estimate.error is None:
        return number(cell.estimate.value, cell.text)
    beside = number(cell.estimate.error, error)
    if cell.look in ("answer", "range"):
        return element("span", shown) + Html(" ") + element("span", "±\u00a0", beside)
    return shown + Html(" ±\u00a0") + beside


def _lines(text: str) -> Iterable[Html | str]:
    """Yield the lines of a text with breaks between them."""
    first, *rest = text.split("\n")
    yield first
    for each in rest:
        yield Html("<br>")
        yield each


def shown_html(shown: Shown) -> Html:
    """Return the text that a cell shows, as HTML; a number carries its full value."""
    text = shown.written or shown_text(shown)
    if isinstance(shown.value, str) or shown.value is None or not math.isfinite(shown.value):
        return element("span", text)
    return number(shown.value, text)


def number(value: float, shown: str) -> Html:
    """Return a number as shown, with its full value for programs that read the page."""
    return element("data", shown, value=plain_text(value))


def estimate_html(estimate: Estimate, written: Callable[[Estimate], str] = estimate_text) -> Html:
    """`11.799 ± 0.013` with the full value; a dash where there is no number."""
    return number(estimate.value, written(estimate)) if math.isfinite(estimate.value) else element("span", NONE)


def share_html(estimate: Estimate) -> Html:
    """`12.3 ± 0.5 %` with the full value; a dash where there is no number."""
    return number(estimate.value, share_text(estimate)) if math.isfinite(estimate.value) else element("span", NONE)
