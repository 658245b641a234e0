"""HTML built from the inside out: a text becomes HTML only by being escaped, so no name in a workbook is markup."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from html import escape
from typing import Final

from xlmc.montecarlo.interruption import checkpoint
from xlmc.outputs.document.unbroken import unbroken

__all__ = ["EMPTY", "Html", "element", "join", "void"]


@dataclass(frozen=True, slots=True)
class Html:
    """Text that is HTML already. Only this module and the page's own template make one from a plain text."""

    source: str

    def __add__(self, other: Html) -> Html:
        return Html(self.source + other.source)

    @staticmethod
    def of_svg(svg: str, message: str, look: str) -> Html:
        """Return an SVG drawing, whose texts are escaped already, with its CSS class and what it shows."""
        named = f'<svg class="{look}" role="img" aria-label="{escape(message)}" '
        return Html(svg.replace("<svg ", named, 1))


EMPTY = Html("")

_VERBATIM: Final = frozenset({"code", "pre", "script", "style", "textarea"})
"""Elements whose text may be typed or read by a program."""


def element(name: str, /, *children: Html | str, **attributes: str | None) -> Html:
    """Return an element; strings in it are escaped, attributes that are None are left out.

    An attribute's underscores stand for hyphens, one at its end for nothing: `class_`, `data_forecast`.

    >>> element("b", "a < b", class_="x").source
    '<b class="x">a &lt; b</b>'
    """
    checkpoint()
    inner = _as_it_is(children) if name in _VERBATIM else join(children).source
    return Html(f"<{name}{_attributes(attributes)}>{inner}</{name}>")


def void(name: str, /, **attributes: str | None) -> Html:
    """Return an element without content and end tag, such as `input`."""
    return Html(f"<{name}{_attributes(attributes)}>")


def join(children: tuple[Html | str, ...] | list[Html]) -> Html:
    """Join children as HTML; strings are escaped."""
    return Html("".join([each.source if isinstance(each, Html) else escape(unbroken(each)) for each in children]))


def _as_it_is(children: tuple[Html | str, ...]) -> str:
    return "".join([each.source if isinstance(each, Html) else escape(each) for each in children])


def _attributes(attributes: dict[str, str | None]) -> str:
    if not attributes:
        return ""
    return "".join([f' {_name(key)}="{escape(value)}"' for key, value in attributes.items() if value is not None])


@cache
def _name(key: str) -> str:
    """Return the name of an attribute in HTML."""
    return key.rstrip("_").replace("_", "-")
