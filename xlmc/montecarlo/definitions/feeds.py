"""Which answer of another workbook an assumption is fed with: `Assumption=other.xlsx!Forecast`."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Final

from xlmc.errors import SimulationError
from xlmc.montecarlo.distributions.spelling import name_key

if TYPE_CHECKING:
    from xlmc.excel.workbook.workbook import Workbook

__all__ = ["Feed", "Feeding", "read_feeds"]

_FORM: Final = "write 'Assumption=other.xlsx!Forecast'"
_IN_BOOK: Final = re.compile(r"(?P<book>.*?\.\w{3,5})!(?P<name>.*)", re.DOTALL)
_SECOND: Final = re.compile(r"[,;].*=.*\.\w{3,5}!", re.DOTALL)
"""What follows in a name where two feeds stand in one text."""


@dataclass(frozen=True, slots=True)
class Feed:
    """An assumption, and the answer of another workbook that it takes in each trial.

    Attributes:
        assumption: its name.
        book: file name of the workbook that has it; empty for the one that is run.
        answer: name of the forecast, or of the assumption, that it takes.
        source: path of the other workbook, as given.
    """

    assumption: str
    book: str
    answer: str
    source: str

    @property
    def file(self) -> str:
        """The file name of the other workbook."""
        return Path(self.source).name

    @property
    def text(self) -> str:
        """The feed as it is typed in the folder of all its workbooks."""
        return f"{f'{self.book}!' if self.book else ''}{self.assumption}={self.file}!{self.answer}"


@dataclass(frozen=True, slots=True)
class Feeding:
    """What feeds a model.

    Attributes:
        feeds: in the order given.
        first: the workbook that is run, as it was read.
        sources: file name -> a workbook that feeds, as it was read.
    """

    feeds: tuple[Feed, ...]
    first: Workbook
    sources: Mapping[str, Workbook]


def read_feeds(given: Iterable[str] | Mapping[str, str]) -> tuple[Feed, ...]:
    """Read feeds as they are typed, or as Python gives them: `{"Assumption": "other.xlsx!Forecast"}`.

    Raises:
        SimulationError: one cannot be read, or an assumption is fed twice.

    >>> read_feeds(["Impact speed=momentum.xlsx!Vehicle 1 impact speed"])[0].source
    'momentum.xlsx'
    >>> read_feeds({"momentum.xlsx!s": "skid.xlsx!d"})[0].book
    'momentum.xlsx'
    """
    pairs = given.items() if isinstance(given, Mapping) else [_cut(text) for text in given]
    feeds = tuple(_feed(*pair) for pair in pairs)
    names = [(feed.book.casefold(), name_key(feed.assumption)) for feed in feeds]
    for feed, name in zip(feeds, names, strict=True):
        if names.count(name) > 1:
            raise SimulationError(f"the assumption {feed.assumption!r} is fed twice", hint="give it one answer")
    return feeds


def _cut(text: str) -> tuple[str, str]:
    mine, _, theirs = text.partition("=")
    return mine, theirs


def _feed(mine: str, theirs: str) -> Feed:
    own, other = _IN_BOOK.fullmatch(mine.strip()), _IN_BOOK.fullmatch(theirs.strip())
    book, assumption = ("", mine.strip()) if own is None else (own["book"].strip(), own["name"].strip())
    if other is None or not assumption or not other["name"].strip():
        raise SimulationError(f"the feed {f'{mine}={theirs}'!r} cannot be read", hint=_FORM)
    if _SECOND.search(other["name"]):
        message = f"the feed {f'{mine}={theirs}'!r} holds two"
        raise SimulationError(message, hint="give --feed once for each (in Python: an entry of the dict for each)")
    return Feed(assumption, Path(book).name if book else "", other["name"].strip(), other["book"].strip())
