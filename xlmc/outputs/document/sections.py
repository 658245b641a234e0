"""The sections of what a run found, in their order: a row each. Their makers are loaded when they are asked."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from importlib import import_module
from typing import TYPE_CHECKING, Final, TypeVar, cast

if TYPE_CHECKING:
    from xlmc.montecarlo.definitions.vocabulary import Vocabulary
    from xlmc.outputs.document.material import Material
    from xlmc.outputs.document.parts import Block

__all__ = ["OUTPUTS", "SECTIONS", "Section", "in_order"]

T = TypeVar("T")

OUTPUTS: Final = ("page", "sheets", "terminal", "notebook")
"""The outputs beside the report, of which some show a section in a form of their own."""


@dataclass(frozen=True, slots=True)
class Section:
    """A section of what a run found. One row here, and it is in the report and in every other output.

    Attributes:
        heading: above it, with the words of the workbook's field in braces.
        make: makes its blocks; none where there is nothing to say.
        elsewhere: output -> where it says the same in other words, or why it does not show it.
        own: output -> its forms of its own there: parts of the page, or sheets.
        asked_for: a report has it only where it is asked for by its name.
    """

    heading: str
    make: Callable[[Material], Iterator[Block]]
    elsewhere: Mapping[str, str] = field(default_factory=dict)
    own: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    asked_for: bool = False

    def is_further(self, output: str) -> bool:
        """Whether an output shows its blocks, as a report does."""
        return output not in self.elsewhere and output not in self.own

    def title(self, words: Vocabulary) -> str:
        """Return the heading in the words of a field."""
        filled = words.fill(self.heading)
        return filled[:1].upper() + filled[1:]


def _from(module: str) -> Callable[[Material], Iterator[Block]]:
    """Return the function `section` of a module of `document.content`, which is loaded when it is called."""

    def make(material: Material) -> Iterator[Block]:
        result = import_module(f"xlmc.outputs.document.content.{module}")
        return cast("Iterator[Block]", result.section(material))

    return make


_IN_WORKBOOK: Final = dict.fromkeys(OUTPUTS, "the workbook itself shows it")
_LONG: Final = dict.fromkeys(("terminal", "notebook"), "too long")
_REPORT_ONLY: Final = dict.fromkeys(OUTPUTS, "it explains the report")

SECTIONS: Final[dict[str, Section]] = {
    "answer": Section(
        "The question and the answer",
        _from("answers"),
        {"terminal": "the first table", "notebook": "Answers"},
        own={"page": ("answer", "second"), "sheets": ("Results",)},
    ),
    "scene": Section("The {drawing}", _from("scene"), _IN_WORKBOOK),
    "scene-trials": Section("Trials over the chart", _from("scene_trials"), {"terminal": "charts are for files"}),
    "forecasts": Section(
        "The forecasts",
        _from("forecasts"),
        {"terminal": "charts are for files", "notebook": "Answers"},
        own={"page": ("forecasts", "overlay"), "sheets": ("Charts",)},
    ),
    "statistics": Section(
        "Statistics of the accepted trials",
        _from("statistics"),
        _LONG,
        own={"page": ("statistics",), "sheets": ("Statistics",)},
        asked_for=True,
    ),
    "certainty": Section(
        "Certainty of ranges",
        _from("certainty"),
        _LONG,
        own={"page": ("certainty",), "sheets": ("Certainty",)},
        asked_for=True,
    ),
    "pairs": Section("Forecasts two at a time", _from("pairs"), _LONG, own={"sheets": ("Pairs",)}, asked_for=True),
    "filters": Section(
        "Filters: what a trial must meet",
        _from("filters"),
        {"terminal": "Trials rejected", "notebook": "Trials rejected"},
        own={"page": ("filters",), "sheets": ("Results",)},
    ),
    "evidence": Section(
        "Evidence, and whether it agrees",
        _from("evidence"),
        {"terminal": "Evidence", "notebook": "too long"},
        own={"page": ("evidence",), "sheets": ("Evidence results",)},
    ),
    "scenarios": Section(
        "Scenarios: the answers if something is changed",
        _from("scenarios"),
        {"terminal": "Scenarios", "notebook": "too long"},
        own={"sheets": ("Scenarios",)},
    ),
    "assumptions": Section(
        "Assumptions",
        _from("assumptions"),
        {"terminal": "xlmc check", "notebook": "shown of the model"},
        own={"page": ("assumptions",), "sheets": ("Assumptions",)},
    ),
    "sensitivity": Section(
        "What the answers depend on",
        _from("sensitivity"),
        {"terminal": "too long", "notebook": "xlmc.sensitivities"},
        own={"page": ("sensitivity",), "sheets": ("Sensitivity",)},
    ),
    "limits": Section(
        "Filter limits: how the answers move as each limit moves",
        _from("limits"),
        _LONG,
        own={"page": ("limits",), "sheets": ("Filter limits",)},
        asked_for=True,
    ),
    "checks": Section(
        "{checks}",
        _from("checks"),
        {"terminal": "Checks", "notebook": "warnings name those that fail"},
        own={"page": ("checks",), "sheets": ("Results",)},
    ),
    "equations": Section("Equations", _from("equations"), _IN_WORKBOOK),
    "notices": Section(
        "Notices",
        _from("notices"),
        {"terminal": "printed first", "notebook": "Notice"},
        own={"page": ("notices",), "sheets": ("Results",)},
    ),
    "repeat": Section(
        "How to repeat this",
        _from("repeat"),
        {"terminal": "files record it", "notebook": "files record it"},
        own={"page": ("record",), "sheets": ("Trials", "Bins", "Curves", "Record")},
    ),
    "glossary": Section("Words", _from("glossary"), _REPORT_ONLY),
}
"""Name -> section, in the order of every output; one without blocks is left out, with its heading."""


def in_order(output: str, own: Mapping[str, T], further: Mapping[str, T]) -> dict[str, T]:
    """Put what an output shows in the order of the sections.

    Args:
        output: one of `OUTPUTS`.
        own: its forms of its own, by the names that rows have; those that no row names come last.
        further: the sections that it shows as blocks, by their names.
    """
    result: dict[str, T] = {}
    for name, section in SECTIONS.items():
        result |= {name: further[name]} if name in further else {}
        result |= {each: own[each] for each in section.own.get(output, ()) if each in own}
    return result | {name: form for name, form in own.items() if name not in result}
