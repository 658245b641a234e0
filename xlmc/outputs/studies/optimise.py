"""What `xlmc optimise` found, as a document: the best decisions, and how sure that is."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import partial
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from xlmc.analysis.studies.optimising import Optimised, RequirementResult, Rival
    from xlmc.outputs.document.parts import Block
    from xlmc.outputs.study_report import StudyReport

__all__ = ["optimise_report"]


def optimise_report(found: Optimised, again: str = "") -> StudyReport:
    """Make the report.

    Args:
        found: what was found.
        again: the command that gives the same again; none where no command was typed.
    """
    from xlmc.montecarlo.number_text import count_text
    from xlmc.outputs.document.parts import Code, Paragraph, blocks_of
    from xlmc.outputs.study_report import StudyReport

    run = found.run
    named = ", ".join(each.name for each in found.decisions)
    below = (
        f"{run.model.workbook.name}: {count_text(found.tried)} candidate{'s' * (found.tried != 1)} for {named}, "
        f"{count_text(found.trials)} trials in all; {count_text(run.trials)} fresh ones of the best, "
        f"seed {run.settings.seed}"
    )
    repeated: list[Block] = [Paragraph("To repeat it:", "small"), Code(again)] if again else []
    blocks = [*_sentences(found), *_blocks(found), _meaning(found), *repeated]
    title = f"The {found.goal.words}"
    kept = None if run.model.definitions.feeding is not None else run  # no file holds fed books with these decisions
    return StudyReport(title, below, blocks_of(blocks), "Optimum", partial(_as_json, found, again), kept)


def _with_values(found: Optimised, values: tuple[float, ...]) -> str:
    from xlmc.analysis.studies.decisions import values_text

    return values_text(found.decisions, values)


def _percent(share: float) -> str:
    """Write a confidence, rounded down.

    >>> [_percent(share) for share in (0.951, 0.99999, 0.02)]
    ['95.1 %', 'more than 99.9 %', '2 %']
    """
    from xlmc.montecarlo.number_text import number_text

    if share > 0.999:
        return "more than 99.9 %"
    return f"{number_text(int(share * 1000.0) / 10.0)} %"


def _small(found: Optimised) -> str:
    from xlmc.montecarlo.number_text import number_text

    measure = found.goal.measure
    if measure.form.factor != 1.0:
        points = number_text(found.indifference * measure.form.factor)
        return f"{points} percentage point{'s' * (points != '1')}"
    text = measure.form.width(found.indifference)
    return f"{text} {measure.units}" if measure.units else text


def _sentences(found: Optimised) -> Iterator[str]:
    from xlmc.montecarlo.number_text import count_text

    measure = found.goal.measure
    extreme = "largest" if found.goal.maximise else "smallest"
    best = _with_values(found, found.best)
    if math.isnan(found.found.value):
        of = f"none of the {count_text(found.tried)} candidates" if found.tried > 1 else "the only candidate"
        gives = "gives no number" if found.tried == 1 else "gives a number"
        yield f"{_capital(of)} that was tried {gives} for {measure.text}."
        yield from _ended(found)
        yield from lost_sentences(found)
        return
    if found.holds:
        yield f"{_capital(measure.text)} is {extreme}, {measure.shown(found.found)}, with {best}."
    else:
        yield from _missing(found, best)
    for each in found.requirements:
        yield _requirement_text(each)
    others = "no other that was tried" if not found.requirements else "no other that was tried and meets this as surely"
    if found.tried == 1:
        yield "It is the only candidate."
    elif found.holds:
        yield (
            f"Of {count_text(found.tried)} candidates, {others} is better by more than {_small(found)}, a difference "
            f"that does not matter here: {_percent(found.confidence)} confidence."
        )
    better = [each for each in found.rivals if each.meets and each.significant and each.ahead > found.indifference]
    for rival in better[: int(found.holds)]:
        yield f"Fresh trials show {_with_values(found, rival.candidate)} to be better: give the search more --runs."
    alike = [each for each in found.rivals if each.meets and not each.significant]
    if alike:
        named = "; ".join(_with_values(found, each.candidate) for each in alike[:4])
        more = f"; and {len(alike) - 4} more" if len(alike) > 4 else ""
        yield f"These trials cannot tell it from {named}{more}."
    if found.as_it_is is not None:
        own = "no number" if math.isnan(found.as_it_is.value) else measure.shown(found.as_it_is)
        lost = f", while errors take {_share(found.lost_as_it_is)} of the trials" * (
            found.lost_as_it_is > found.allowed
        )
        yield f"With the workbook's own decisions {measure.text} is {own}{lost}."
    yield from lost_sentences(found)
    yield from _without_number(found)
    yield from _ended(found)


def _missing(found: Optimised, best: str) -> Iterator[str]:
    """Yield what is said first where the best of the search misses a requirement by fresh trials."""
    measure = found.goal.measure
    others = [each for each in found.rivals if each.meets]
    if not others:
        yield (
            f"No candidate that was tried meets what is required. With {best}, which misses it the least, "
            f"{measure.text} is {measure.shown(found.found)}."
        )
        return
    yield (
        f"By fresh trials {best}, the best of the search with {measure.shown(found.found)}, misses what is required; "
        f"{_with_values(found, others[0].candidate)} meets it. More trials (-n) tell more."
    )


def _ended(found: Optimised) -> Iterator[str]:
    if found.ended:
        yield f"The search ended early, because {found.ended}: this is the best that was found by then."


def _without_number(found: Optimised) -> Iterator[str]:
    """Yield how many candidates give no number, and which texts nobody says."""
    from xlmc.montecarlo.number_text import count_text

    if found.numberless:
        count = found.numberless
        yield (
            f"{count_text(count)} candidate{'s give' if count > 1 else ' gives'} no number, since no trial was "
            "accepted, or the workbook is not possible with these values."
        )
    if found.indifferent:
        yield "All candidates give the same: the decisions do not change what is asked for."
    for name, text in found.unsaid:
        texts = ", ".join(f"“{each}”" for each in found.run.labels.get(name, ()))
        yield f"With these decisions no trial of {name} says “{text}”; its texts are {texts}."


def lost_sentences(found: Optimised) -> Iterator[str]:
    """Yield what is to be known of trials that errors take; nothing where they take few of any candidate."""
    from xlmc.montecarlo.number_text import count_text

    most = _share(found.allowed)
    if not found.is_whole:
        yield (
            f"Errors in cells take {_share(found.lost)} of the trials of these decisions, and {most} is allowed. Mend "
            "the cells, filter such trials out, or allow them (--allow-lost)."
        )
    if found.excluded:
        count = len(found.excluded)
        yield (
            f"{count_text(count)} candidate{'s lose' if count > 1 else ' loses'} more than {most} of the trials to "
            "errors in cells, and cannot be the best: what the lost trials would be is not known."
        )
    better = [each for each in found.excluded if each.looks_better]
    if better:
        named = "; ".join(f"{_with_values(found, each.candidate)} (loses {_share(each.lost)})" for each in better[:4])
        more = f"; and {count_text(len(better) - 4)} more" if len(better) > 4 else ""
        yield f"By the trials that are left these would be better: {named}{more}."


def _share(share: float) -> str:
    """Write a share of trials.

    >>> [_share(share) for share in (0.001, 0.25, 0.12345)]
    ['0.1 %', '25 %', '12 %']
    """
    from xlmc.montecarlo.number_text import number_text

    return f"{number_text(100.0 * share, 2)} %"


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:]


def _requirement_text(each: RequirementResult) -> str:
    left, requirement = each.requirement.left, each.requirement
    shown = left.shown(each.found)
    if each.exact:
        return f"{requirement.text}: {'met' if each.chance > 0.5 else 'missed'}, {shown}."
    if each.chance <= 0.5:
        return f"{requirement.text} fails: {shown}."
    return f"{requirement.text} holds with {_percent(each.chance)} confidence: {shown}."


def _blocks(found: Optimised) -> Iterator[Block]:
    from xlmc.outputs.document.parts import Chart, Figure, Line, Lines, Table

    own = [found.run.model.workbook.content(each.cell).value for each in found.decisions]
    assert len(own) == len(found.best)
    rows = [
        (each.name, each.shown(value), each.units, str(each.cell))
        for each, value in zip(found.decisions, found.best, strict=True)
    ]
    if math.isnan(found.found.value):
        return
    title = "The best decisions" if found.holds else "The decisions"
    yield Table(title, ("Decision", "Value", "Units", "Cell"), tuple(rows), (1,))
    if found.requirements:
        stand = [
            (
                each.requirement.text,
                each.requirement.left.shown(each.found),
                "" if each.exact else _percent(each.chance),
            )
            for each in found.requirements
        ]
        yield Table("What is required", ("Requirement", "Found", "Holds with"), tuple(stand), (1, 2))
    if found.rivals:
        heads = (*(each.name for each in found.decisions), "Better by", "Significant", "Meets the requirements")
        heads = heads if found.requirements else heads[:-1]
        lines = [_rival_row(found, each)[: len(heads)] for each in found.rivals]
        yield Table("Others that come near", heads, tuple(lines), tuple(range(len(found.decisions) + 1)))
    if len(found.curve) > 1:
        (decision,) = found.decisions
        across = f"{decision.name}, {decision.units}" if decision.units else decision.name
        said = f"{found.goal.measure.text} for the values of {decision.name} that were tried"
        lines_drawn = Lines((Line(_capital(found.goal.measure.text), found.curve),), _axis(found), now=found.best[0])
        yield Figure(Chart("", across, lines_drawn, said), said)


def _axis(found: Optimised) -> str:
    measure = found.goal.measure
    return f"{measure.text}, {measure.units}" if measure.units else measure.text


def _rival_row(found: Optimised, each: Rival) -> tuple[str, ...]:
    from xlmc.montecarlo.statistics import Estimate

    form = found.goal.measure.form
    sign = "+" if each.ahead > 0.0 else ""
    ahead = f"{sign}{form.spread(Estimate(each.ahead, each.error))}"
    significant = "yes" if each.significant else "no"
    values = (one.shown(at) for one, at in zip(found.decisions, each.candidate, strict=True))
    return (*values, ahead, significant, "yes" if each.meets else "no")


def _meaning(found: Optimised) -> str:
    return (
        f"The candidates come from {found.how}, over random numbers that all share (seed {found.search_seed}); the "
        "numbers of the best come from fresh ones, so that being chosen does not make it look better. They are what "
        "`xlmc simulate` gives of the workbook with these decisions typed in. ± is the standard error "
        "(Monte Carlo error)."
    )


def _contents(found: Optimised, values: tuple[float, ...]) -> list[float | str | bool]:
    return [each.content(value) for each, value in zip(found.decisions, values, strict=True)]


def _as_json(found: Optimised, again: str) -> dict[str, object]:
    from xlmc.outputs.studies.json_numbers import estimate_json

    run = found.run
    return {
        "book": str(run.model.path),
        "goal": {"text": found.goal.measure.text, "maximise": found.goal.maximise},
        "decisions": [
            {"name": each.name, "cell": str(each.cell), "units": each.units, "value": each.content(value)}
            for each, value in zip(found.decisions, found.best, strict=True)
        ],
        "found": estimate_json(found.found),
        "as_it_is": None if found.as_it_is is None else estimate_json(found.as_it_is),
        "requirements": [
            {
                "text": each.requirement.text,
                "found": estimate_json(each.found),
                "probability": each.chance,
            }
            for each in found.requirements
        ],
        "indifference": found.indifference,
        "confidence": found.confidence,
        "others": [
            {
                "values": _contents(found, each.candidate),
                "better_by": {"value": each.ahead, "error": each.error},
                "significant": each.significant,
                "meets_requirements": each.meets,
                "probability_better": each.chance,
                "trials": each.trials,
            }
            for each in found.rivals
        ],
        "lost": {"share": found.lost, "as_it_is": found.lost_as_it_is, "allowed": found.allowed},
        "excluded": [
            {"values": _contents(found, each.candidate), "lost": each.lost, "looks_better": each.looks_better}
            for each in found.excluded
        ],
        "tried": found.tried,
        "trials_in_all": found.trials,
        "trials": run.trials,
        "seed": run.settings.seed,
        "search_seed": found.search_seed,
        "search": found.how,
        "ended_early": found.ended or None,
        "command": again,
    }
