"""The sections of what a run found, in their order: a row each. Their makers are loaded when they are asked."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from importlib import import_module
from typing import TYPE_CHECKING, Final, cast

if TYPE_CHECKING:
    from xlmc.montecarlo.definitions.vocabulary import Vocabulary
    from xlmc.outputs.document.material import Material
    from xlmc.outputs.document.parts import Block

__all__ = ["OUTPUTS", "SECTIONS", "Section"]

OUTPUTS: Final = ("page", "sheets", "terminal", "notebook")
"""The outputs beside the report, of which some show a section in a form of their own."""


@dataclass(frozen=True, slots=True)
class Section:
    """A section of what a run found. One row here, and it is in the report and in every other output.

    Attributes:
        heading: above it, with the words of the workbook's field in braces.
        make: makes its blocks; none where there is nothing to say.
        elsewhere: output -> where it says the same in a form of its own, or why it does not show it.
        asked_for: a report has it only where it is asked for by its name.
    """

    heading: str
    make: Callable[[Material], Iterator[Block]]
    elsewhere: Mapping[str, str] = field(default_factory=dict)
    asked_for: bool = False

    def title(self, words: Vocabulary) -> str:
        """Return the heading in the words of a field."""
        filled = words.fill(self.heading)
        return filled[:1].upper() + filled[1:]


def _from(module: str) -> Callable[[Material], Iterator[Block]]:
    """Return the function `section` of a module of `document.content`, which is loaded when it is called."""

    def make(material: Material) -> Iterator[Block]:
        found = import_module(f"xlmc.outputs.document.content.{module}")
        return cast("Iterator[Block]", found.section(material))

    return make


_STATED: Final = {"page": "The answer", "sheets": "Results", "terminal": "the first table", "notebook": "Answers"}
_IN_WORKBOOK: Final = dict.fromkeys(OUTPUTS, "the workbook itself shows it")
_LONG: Final = dict.fromkeys(("terminal", "notebook"), "too long")
_REPORT_ONLY: Final = dict.fromkeys(OUTPUTS, "it explains the report")

SECTIONS: Final[dict[str, Section]] = {
    "answer": Section("The question and the answer", _from("answers"), _STATED),
    "scene": Section("The {drawing}", _from("scene"), _IN_WORKBOOK),
    "scene-trials": Section("Trials over the chart", _from("scene_trials"), {"terminal": "charts are for files"}),
    "forecasts": Section(
        "The forecasts",
        _from("forecasts"),
        {"page": "Forecasts", "sheets": "Charts", "terminal": "charts are for files", "notebook": "Answers"},
    ),
    "filters": Section(
        "Filters: what a trial must meet",
        _from("filters"),
        {
            "page": "Trials and filters",
            "sheets": "Results",
            "terminal": "Trials rejected",
            "notebook": "Trials rejected",
        },
    ),
    "evidence": Section(
        "Evidence, and whether it agrees",
        _from("evidence"),
        {"page": "Evidence", "sheets": "Evidence results", "terminal": "Evidence", "notebook": "too long"},
    ),
    "scenarios": Section(
        "Scenarios: the answers if something is changed",
        _from("scenarios"),
        {"page": "Scenarios", "sheets": "Scenarios", "terminal": "Scenarios", "notebook": "too long"},
    ),
    "assumptions": Section(
        "Assumptions",
        _from("assumptions"),
        {"page": "Assumptions", "sheets": "Assumptions", "terminal": "xlmc check", "notebook": "shown of the model"},
    ),
    "sensitivity": Section(
        "What the answers depend on",
        _from("sensitivity"),
        {"page": "Sensitivity", "sheets": "Sensitivity", "terminal": "too long", "notebook": "xlmc.sensitivities"},
    ),
    "certainty": Section(
        "Certainty of ranges",
        _from("certainty"),
        {"page": "Certainty of ranges", "sheets": "Certainty", **_LONG},
        asked_for=True,
    ),
    "pairs": Section(
        "Forecasts two at a time",
        _from("pairs"),
        {"page": "Forecasts two at a time", "sheets": "Pairs", **_LONG},
        asked_for=True,
    ),
    "statistics": Section(
        "Statistics of the accepted trials",
        _from("statistics"),
        {"page": "Statistics", "sheets": "Statistics", **_LONG},
        asked_for=True,
    ),
    "limits": Section(
        "Filter limits: how the answers move as each limit moves",
        _from("limits"),
        {"page": "Filter limits", "sheets": "Filter limits", **_LONG},
        asked_for=True,
    ),
    "checks": Section(
        "{checks}",
        _from("checks"),
        {"page": "Checks", "sheets": "Results", "terminal": "Checks", "notebook": "warnings name those that fail"},
    ),
    "equations": Section("Equations", _from("equations"), _IN_WORKBOOK),
    "notices": Section(
        "Notices",
        _from("notices"),
        {"page": "Notices", "sheets": "Results", "terminal": "printed first", "notebook": "Notice"},
    ),
    "repeat": Section(
        "How to repeat this",
        _from("repeat"),
        {"page": "Record", "sheets": "Record", "terminal": "files record it", "notebook": "files record it"},
    ),
    "glossary": Section("Words", _from("glossary"), _REPORT_ONLY),
}
"""Name -> section; one without blocks is left out, with its heading."""
