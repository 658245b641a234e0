"""The errors a run met in cells: where, which, in how many trials."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from xlmc.analysis.results.record.needed_cells import content_text
from xlmc.errors import ErrorCode
from xlmc.excel.address import Cell, host_of
from xlmc.montecarlo.diagnostics.cell_errors import Root
from xlmc.montecarlo.model.solving import fault_text
from xlmc.montecarlo.number_text import count_text, number_text

if TYPE_CHECKING:
    from xlmc.montecarlo.simulation.simulation import RunResult

__all__ = ["ErrorMet", "errors_met", "lost_sentences", "rest_sentences"]

_WORDS: Final = {
    "text": "is a text",
    "blank": "is blank",
    "parameters are not a distribution": "has parameters that are not a distribution",
}
_MOST_NAMED: Final = 5


@dataclass(frozen=True, slots=True)
class ErrorMet:
    """One kind of error in one cell.

    Attributes:
        kind: `filter`, `forecast` or `assumption`.
        error: the Excel error, `text`, `blank`, or what is wrong with the parameters.
        trials: all trials for filters and assumptions, accepted ones for forecasts.
        root: the cell that the error comes from, and its error there; None if it is not known, or the cell itself.
    """

    kind: str
    name: str
    cell: Cell
    error: str
    trials: int
    root: Root | None = None

    @property
    def what(self) -> str:
        """`Model!D12 #DIV/0!`, `Model!D12 is a text`."""
        return f"{self.cell} {_WORDS.get(self.error, self.error)}"


def errors_met(simulation: RunResult) -> list[ErrorMet]:
    """Every kind of error met, in the order of the definitions."""
    return list(_errors(simulation))


def _errors(simulation: RunResult) -> Iterator[ErrorMet]:
    model, roots = simulation.model, simulation.error_roots
    for filter_, errors in zip(model.filters, simulation.tally.errors, strict=True):
        yield from _of("filter", filter_.name, filter_.cell, errors, roots)
    for forecast in model.forecasts:
        yield from _of("forecast", forecast.name, forecast.cell, simulation.faults[forecast.name], roots)
    for assumption in model.assumptions:
        invalid = Counter({"parameters are not a distribution": simulation.invalid[assumption.name]})
        yield from _of("assumption", assumption.name, assumption.cell, invalid, {})


def _of(kind: str, name: str, cell: Cell, errors: Counter[str], roots: Mapping[Cell, Root]) -> Iterator[ErrorMet]:
    root = roots.get(cell)
    for error, count in sorted(errors.items()):
        if count:
            comes = root is not None and root[0] != cell and root[1].text == error
            yield ErrorMet(kind, name, cell, error, count, root if comes else None)


def lost_sentences(simulation: RunResult) -> list[str]:
    """Return the cells in which trials were lost, most trials first, and how many trials are left; nothing without
    losses.

    Sentences have no full stop.
    """
    if not simulation.error_trials:
        return []
    errors = sorted(errors_met(simulation), key=lambda met: -met.trials)
    lines = [_lost(simulation, met) for met in errors[:_MOST_NAMED]]
    lines += [f"… and {len(errors) - _MOST_NAMED} more, all on the sheet Results"] if len(errors) > _MOST_NAMED else []
    return [*lines, *rest_sentences(simulation)]


def _lost(simulation: RunResult, met: ErrorMet) -> str:
    accepted = met.kind == "forecast" and bool(simulation.model.filters)
    of = simulation.accepted if met.kind == "forecast" else simulation.trials
    share = float(f"{100 * met.trials / max(of, 1):.2g}")
    sentence = (
        f"{met.what} in {count_text(met.trials)} of {count_text(of)} "
        f"{'accepted ' * accepted}trials ({number_text(share)} %)"
    )
    if met.root is None:
        why = fault_text(simulation.model.definitions.solves, met.cell, _code(met.error))
        return f"{sentence}: {why}" if why else sentence
    cell, code = met.root
    why = fault_text(simulation.model.definitions.solves, cell, code)
    model = simulation.model
    content = content_text(model.workbook, host_of(cell), tabulated=model.tabulated)
    return f"{sentence}, from {cell} {code.text}: {why or content}"


def _code(error: str) -> ErrorCode | None:
    """Return the error that a text says; None where it says something else."""
    return next((code for code in ErrorCode if code.text == error), None)


def rest_sentences(simulation: RunResult) -> list[str]:
    """How many trials the statistics rest on, one sentence a number of trials."""
    counts: dict[int, list[str]] = {}
    for name, result in simulation.results.items():
        counts.setdefault(int(result.values.size), []).append(name)
    of = count_text(simulation.trials) if simulation.rare is None else f"{count_text(simulation.accepted)} accepted"
    if not counts:
        return []
    most = max(counts, key=lambda count: len(counts[count]))
    first = f" of {counts[most][0]!r}" if len(counts) > 1 and len(counts[most]) == 1 else ""
    others = [f"those of {_listed(names)} on {count_text(count)}" for count, names in counts.items() if count != most]
    return ["; ".join([f"Statistics{first} rest on {count_text(most)} of {of} trials", *others])]


def _listed(names: list[str]) -> str:
    return ", ".join(map(repr, names))
