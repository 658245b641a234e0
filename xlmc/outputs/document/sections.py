"""The sections of what a run found, in their order: a row each. Their makers are loaded when they are asked."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from xlmc.montecarlo.definitions.vocabulary import Vocabulary
    from xlmc.outputs.document.parts import Block
    from xlmc.outputs.document.report_sections import Material

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


def _in_report(name: str) -> Callable[[Material], Iterator[Block]]:
    def make(material: Material) -> Iterator[Block]:
        from xlmc.outputs.document.report_sections import MAKERS

        return MAKERS[name](material)

    return make


_STATED: Final = {"page": "The answer", "sheets": "Results", "terminal": "the first table", "notebook": "Answers"}
_IN_WORKBOOK: Final = dict.fromkeys(OUTPUTS, "the workbook itself shows it")
_LONG: Final = dict.fromkeys(("terminal", "notebook"), "too long")
_REPORT_ONLY: Final = dict.fromkeys(OUTPUTS, "it explains the report")

SECTIONS: Final[dict[str, Section]] = {
    "answer": Section("The question and the answer", _in_report("answer"), _STATED),
    "scene": Section("The {drawing}", _in_report("scene"), _IN_WORKBOOK),
    "scene-trials": Section("Trials over the chart", _in_report("scene-trials"), {"terminal": "charts are for files"}),
    "forecasts": Section(
        "The forecasts",
        _in_report("forecasts"),
        {"page": "Forecasts", "sheets": "Charts", "terminal": "charts are for files", "notebook": "Answers"},
    ),
    "filters": Section(
        "Filters: what a trial must meet",
        _in_report("filters"),
        {
            "page": "Trials and filters",
            "sheets": "Results",
            "terminal": "Trials rejected",
            "notebook": "Trials rejected",
        },
    ),
    "evidence": Section(
        "Evidence, and whether it agrees",
        _in_report("evidence"),
        {"page": "Evidence", "sheets": "Evidence results", "terminal": "Evidence", "notebook": "too long"},
    ),
    "scenarios": Section(
        "Scenarios: the answers if something is changed",
        _in_report("scenarios"),
        {"page": "Scenarios", "sheets": "Scenarios", "terminal": "Scenarios", "notebook": "too long"},
    ),
    "assumptions": Section(
        "Assumptions",
        _in_report("assumptions"),
        {"page": "Assumptions", "sheets": "Assumptions", "terminal": "xlmc check", "notebook": "shown of the model"},
    ),
    "sensitivity": Section(
        "What the answers depend on",
        _in_report("sensitivity"),
        {"page": "Sensitivity", "sheets": "Sensitivity", "terminal": "too long", "notebook": "xlmc.sensitivities"},
    ),
    "certainty": Section(
        "Certainty of ranges",
        _in_report("certainty"),
        {"page": "Certainty of ranges", "sheets": "Certainty", **_LONG},
        asked_for=True,
    ),
    "pairs": Section(
        "Forecasts two at a time",
        _in_report("pairs"),
        {"page": "Forecasts two at a time", "sheets": "Pairs", **_LONG},
        asked_for=True,
    ),
    "statistics": Section(
        "Statistics of the accepted trials",
        _in_report("statistics"),
        {"page": "Statistics", "sheets": "Statistics", **_LONG},
        asked_for=True,
    ),
    "checks": Section(
        "{checks}",
        _in_report("checks"),
        {"page": "Checks", "sheets": "Results", "terminal": "Checks", "notebook": "warnings name those that fail"},
    ),
    "equations": Section("Equations", _in_report("equations"), _IN_WORKBOOK),
    "notices": Section(
        "Notices",
        _in_report("notices"),
        {"page": "Notices", "sheets": "Results", "terminal": "printed first", "notebook": "Notice"},
    ),
    "repeat": Section(
        "How to repeat this",
        _in_report("repeat"),
        {"page": "Record", "sheets": "Record", "terminal": "files record it", "notebook": "files record it"},
    ),
    "glossary": Section("Words", _in_report("glossary"), _REPORT_ONLY),
}
"""Name -> section; one without blocks is left out, with its heading."""
