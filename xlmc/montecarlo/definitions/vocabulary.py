"""Words that depend on what a workbook is about: a crash, or anything else.

A template for crashes says so by the category in its properties, which programs keep when they save the workbook.
Sentences name the words that depend on it in braces: `{model_error}`.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from xlmc.excel.workbook.workbook import Workbook

__all__ = ["CRASH", "NEUTRAL", "Vocabulary", "vocabulary_of"]

_CRASH_CATEGORY: Final = "rung "


@dataclass(frozen=True, slots=True)
class Vocabulary:
    """The words for what a workbook describes.

    Attributes:
        model_error: what a model may be wrong by.
        fits: what a right model does.
        case: what a trial is a possible one of.
        asker: who asks for evidence.
        such_as: an example of a filter, after a comma; may be empty.
        drawing: what the workbook draws.
        checks: what the checks are called.
        misfits: why a model may not apply, in parentheses after a space; may be empty.
        balances: whether it matters what is more probable than not, as in court.
    """

    model_error: str
    fits: str
    case: str
    asker: str
    such_as: str
    drawing: str
    checks: str
    misfits: str = ""
    balances: bool = False

    def fill(self, text: str) -> str:
        """Return the text with these words in place of their names in braces."""
        return text.format_map(asdict(self))


CRASH: Final = Vocabulary(
    "reconstruction error",
    "fits the crash",
    "crash",
    "an opponent",
    ", such as a restitution between 0 and 1",
    "scene",
    "physics checks",
    " (second impact, tyre forces, a pulse that was cut off)",
    balances=True,
)
NEUTRAL: Final = Vocabulary("model error", "is right", "case", "a reader", "", "drawing", "checks")


def vocabulary_of(workbook: Workbook) -> Vocabulary:
    """Return the words for a workbook: those for a crash if it was made from a template for crashes."""
    return CRASH if workbook.category.startswith(_CRASH_CATEGORY) else NEUTRAL
