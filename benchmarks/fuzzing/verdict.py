"""Which outcomes are fine: xlmc did what was asked, or said in words that a person can use why not."""

from __future__ import annotations

import re
import traceback
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import xlmc
from fuzzing.inputs import Disagreement
from xlmc.errors import SimulationError, XlmcError

__all__ = ["Finding", "complaint", "of_error"]

_OF_PYTHON: Final = re.compile(
    r"Traceback|<xlmc|<class|<function| object at 0x|array\(|dtype|NoneType|Cell\(|Area\(|\bNone\b|Decimal\("
)
_PLACE: Final = re.compile(
    r"!\$?[A-Z]{1,3}\$?\d|\b(xl|docProps|_rels|columns)/|\.xlsx|\.html|\.json|\.xlmcrun|run\.json|\b[Ss]heet\b|xlmc_"
    r"|\[Content_Types\]|\bthe package\b"
)
_PACKAGE: Final = Path(xlmc.__file__).parent
_SHOWN: Final = 12


@dataclass(frozen=True, slots=True)
class Finding:
    """What is not fine.

    Attributes:
        key: the same for findings that have one cause, as far as one can tell: the exception's type and its place.
        detail: for whoever mends it.
    """

    key: str
    detail: str


def of_error(error: BaseException) -> Finding | None:
    """What is wrong with an exception that came out of xlmc; None where it is a message for a person."""
    if isinstance(error, XlmcError):
        wrong = complaint(error)
        return None if wrong is None else Finding(f"message {wrong}: {_place(error)}", f"{str(error)[:1000]!r}")
    if isinstance(error, Disagreement):
        return Finding(f"disagreement: {str(error).partition(':')[0]}", str(error))
    return Finding(f"{type(error).__name__} at {_place(error)}", _shortened(error))


def complaint(error: XlmcError) -> str | None:
    """What is wrong with a message. A place is a cell, a part or a file; what a run may not be asked has none.

    Control characters are no matter here: what prints a message escapes them.
    """
    text = str(error)
    if not error.message.strip():
        return "is empty"
    if _OF_PYTHON.search(text):
        return "speaks of Python"
    if (
        error.where is None
        and not (isinstance(error, SimulationError) and error.hint)
        and not all(_PLACE.search(line) for line in text.splitlines())
    ):
        return "has no place"
    return None


def _place(error: BaseException) -> str:
    """File, function and line of the innermost frame in xlmc."""
    own = [frame for frame in _frames(error) if _PACKAGE in Path(frame.filename).parents]
    if not own:
        return "outside xlmc"
    return f"{Path(own[-1].filename).relative_to(_PACKAGE)}:{own[-1].name}:{own[-1].lineno}"


def _frames(error: BaseException) -> Sequence[traceback.FrameSummary]:
    frames = traceback.walk_tb(error.__traceback__)
    return traceback.StackSummary.extract(frames, lookup_lines=False)


def _shortened(error: BaseException) -> str:
    """The last frames and the message; a stack that ran over has thousands."""
    lines = [f"{frame.filename}:{frame.lineno} {frame.name}" for frame in _frames(error)]
    left_out = ["…"] if len(lines) > _SHOWN else []
    return "\n".join([*left_out, *lines[-_SHOWN:], f"{type(error).__name__}: {str(error)[:500]}"])
