"""The document of a run: what is asked for is checked, and the sections are put together."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import count
from typing import TYPE_CHECKING, Final

from xlmc.analysis.results.record import make_record
from xlmc.analysis.studies.scenario_answers import scenario_answers
from xlmc.errors import SimulationError
from xlmc.excel.workbook.printable import label
from xlmc.montecarlo.definitions.number_styles import in_style_of
from xlmc.montecarlo.definitions.vocabulary import vocabulary_of
from xlmc.montecarlo.distributions.spelling import name_key
from xlmc.montecarlo.number_text import count_text
from xlmc.outputs.case_fields import case_of
from xlmc.outputs.document.material import Material, same_answers
from xlmc.outputs.document.parts import Block, Document, Figure, Heading, Table
from xlmc.outputs.document.sections import SECTIONS

if TYPE_CHECKING:
    from xlmc.montecarlo.model.model import CompiledModel
    from xlmc.montecarlo.simulation.simulation import RunResult

__all__ = ["PAPERS", "Wanted", "build", "check_wanted", "check_wanted_of", "further_sections", "units_of"]

PAPERS: Final = ("letter", "a4")


@dataclass(frozen=True, slots=True)
class Wanted:
    """What a report is to hold.

    Attributes:
        case: fields of the case, which win over those of the table `xlmc_case`.
        sections: names of sections; empty for all but those that are to be asked for.
        forecasts: names of forecasts, whatever their case; empty for all.
        paper: of the pages: `letter` or `a4`.
    """

    case: Mapping[str, str] = field(default_factory=dict)
    sections: Sequence[str] = ()
    forecasts: Sequence[str] = ()
    paper: str = "letter"


def check_wanted(wanted: Wanted) -> None:
    """Refuse, before a long run, what no report has.

    Raises:
        SimulationError: there is no such section or paper.
    """
    for name in wanted.sections:
        if name not in SECTIONS:
            raise SimulationError(f"a report has no section {label(name)!r}", hint=f"choose from {', '.join(SECTIONS)}")
    if wanted.paper not in PAPERS:
        raise SimulationError(f"there is no paper {label(wanted.paper)!r}", hint=f"choose from {', '.join(PAPERS)}")


def check_wanted_of(wanted: Wanted, model: CompiledModel) -> None:
    """Refuse, before a long run, what the report of this workbook cannot hold.

    Raises:
        DefinitionError: the table `xlmc_case` is not what it must be.
        SimulationError: there is no such forecast, section or paper.
    """
    check_wanted(wanted)
    case_of(model.workbook, wanted.case)
    _forecasts(wanted, model)


@in_style_of("settings.number_style")
def build(simulation: RunResult, wanted: Wanted, *, command: str | None = None) -> Document:
    """Build the report of a run; the same run and the same selection give the same document.

    Args:
        simulation: the finished run.
        wanted: what is typed on the first page, and the selected sections, forecasts and paper.
        command: what the person typed, for the record.

    Raises:
        DefinitionError: the table `xlmc_case` is not what it must be.
        SimulationError: there is no such forecast, section or paper.
    """
    check_wanted(wanted)
    workbook = simulation.model.workbook
    case = case_of(workbook, wanted.case)
    scenario_answers(simulation)  # cells may ask about them, and warnings tell of those that cannot
    names = _forecasts(wanted, simulation.model)
    material = Material(simulation, make_record(simulation, command), names, same_answers(simulation, names))
    blocks: list[Block] = []
    words = vocabulary_of(workbook)
    for name, section in SECTIONS.items():
        is_wanted = name in wanted.sections if wanted.sections else not section.asked_for
        result = list(section.make(material)) if is_wanted else []
        blocks += [Heading(section.title(words)), *result] if result else []
    title = case["Title"] or f"Results of {workbook.name}"
    number = case["Case number"]
    cover = [(name, text) for name, text in case.fields.items() if name != "Title"]
    cover += [("Workbook", workbook.name), ("SHA-256 of the workbook", workbook.sha256)]
    were = "was" if simulation.accepted == 1 else "were"
    counted = f"{count_text(simulation.evaluated)}, of which {count_text(simulation.accepted)} {were} accepted"
    cover += [("Trials", counted)]
    cover += [("Seed", f"{simulation.settings.seed}")]
    return Document(
        title=title,
        author=case["Analyst"],
        dated=case.dated,
        head=f"Case {number}" if number else title,
        foot=f"{workbook.name}, seed {simulation.settings.seed}",
        cover=tuple(cover),
        blocks=tuple(_numbered(blocks)),
        paper=wanted.paper,
        units=units_of(simulation.model),
    )


def units_of(model: CompiledModel) -> tuple[str, ...]:
    """Return the units of the forecasts and assumptions."""
    units = [each.units for each in model.forecasts] + [each.units for each in model.assumptions]
    return tuple(dict.fromkeys(filter(None, units)))


def _numbered(blocks: Iterable[Block]) -> Iterator[Block]:
    """Yield the blocks, figures and tables with their numbers before their captions."""
    figures, tables = count(1), count(1)
    for block in blocks:
        if isinstance(block, Figure) and block.caption:
            yield replace(block, caption=f"Figure {next(figures)}. {block.caption}")
        elif isinstance(block, Table) and block.caption:
            yield replace(block, caption=f"Table {next(tables)}. {block.caption}")
        else:
            yield block


@in_style_of("settings.number_style")
def further_sections(simulation: RunResult, output: str) -> dict[str, tuple[str, list[Block]]]:
    """Return the sections that an output shows as the report does: name -> heading and blocks.

    Args:
        simulation: the finished run.
        output: one of `OUTPUTS`, whose other sections have a form of their own there.
    """
    rows = {name: section for name, section in SECTIONS.items() if section.is_further(output)}
    if not rows:
        return {}
    material = Material(simulation, make_record(simulation, None), _forecasts(Wanted(), simulation.model))
    words = vocabulary_of(simulation.model.workbook)
    result = {name: (section.title(words), list(section.make(material))) for name, section in rows.items()}
    return {name: (heading, blocks) for name, (heading, blocks) in result.items() if blocks}


def _forecasts(wanted: Wanted, model: CompiledModel) -> tuple[str, ...]:
    """Return the names of the selected forecasts, as the workbook spells them.

    Raises:
        SimulationError: there is no such forecast.
    """
    known = {name_key(each.name): each.name for each in model.forecasts}
    for name in wanted.forecasts:
        if name_key(name) not in known:
            hint = f"choose from {', '.join(map(repr, known.values()))}"
            raise SimulationError(f"there is no forecast {label(name)!r}", hint=hint)
    keys = {name_key(name) for name in wanted.forecasts}
    return tuple(name for key, name in known.items() if not keys or key in keys)
