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


def optimise_report(result: Optimised, again: str = "") -> StudyReport:
    """Make the report.

    Args:
        result: what was found.
        again: the command that gives the same again; none where no command was typed.
    """
    from xlmc.montecarlo.number_text import count_text
    from xlmc.outputs.document.parts import Code, Paragraph, blocks_of
    from xlmc.outputs.study_report import StudyReport

    run = result.run
    named = ", ".join(each.name for each in result.decisions)
    below = (
        f"{run.model.workbook.name}: {count_text(result.tried)} candidate{'s' * (result.tried != 1)} for {named}, "
        f"{count_text(result.trials)} trials in all; {count_text(run.trials)} fresh ones of the best, "
        f"seed {run.settings.seed}"
    )
    repeated: list[Block] = [Paragraph("To repeat it:", "small"), Code(again)] if again else []
    blocks = [*_sentences(result), *_blocks(result), _meaning(result), *repeated]
    title = f"The {result.goal.words}"
    kept = None if run.model.definitions.feeding is not None else run  # no file holds fed books with these decisions
    return StudyReport(title, below, blocks_of(blocks), "Optimum", partial(_as_json, result, again), kept)


def _with_values(result: Optimised, values: tuple[float, ...]) -> str:
    from xlmc.analysis.studies.decisions import values_text

    return values_text(result.decisions, values)


def _percent(share: float) -> str:
    """Write a confidence, rounded down.

    >>> [_percent(share) for share in (0.951, 0.99999, 0.02)]
    ['95.1 %', 'more than 99.9 %', '2 %']
    """
    from xlmc.montecarlo.number_text import number_text

    if share > 0.999:
        return "more than 99.9 %"
    return f"{number_text(int(share * 1000.0) / 10.0)} %"


def _small(result: Optimised) -> str:
    from xlmc.montecarlo.number_text import number_text

    measure = result.goal.measure
    if measure.form.factor != 1.0:
        points = number_text(result.indifference * measure.form.factor)
        return f"{points} percentage point{'s' * (points != '1')}"
    text = measure.form.width(result.indifference)
    return f"{text} {measure.units}" if measure.units else text


def _sentences(result: Optimised) -> Iterator[str]:
    from xlmc.montecarlo.number_text import count_text

    measure = result.goal.measure
    extreme = "largest" if result.goal.maximise else "smallest"
    best = _with_values(result, result.best)
    if math.isnan(result.estimate.value):
        of = f"none of the {count_text(result.tried)} candidates" if result.tried > 1 else "the only candidate"
        gives = "gives no number" if result.tried == 1 else "gives a number"
        yield f"{_capital(of)} that was tried {gives} for {measure.text}."
        yield from _ended(result)
        yield from lost_sentences(result)
        return
    if result.holds:
        yield f"{_capital(measure.text)} is {extreme}, {measure.shown(result.estimate)}, with {best}."
    else:
        yield from _missing(result, best)
    for each in result.requirements:
        yield _requirement_text(each)
    others = (
        "no other that was tried" if not result.requirements else "no other that was tried and meets this as surely"
    )
    if result.tried == 1:
        yield "It is the only candidate."
    elif result.holds:
        small = f" by more than {_small(result)}, a difference that does not matter here" if result.indifference else ""
        sure = f"{_percent(result.confidence)} confidence"
        yield f"Of {count_text(result.tried)} candidates, {others} is better{small}: {sure}."
    better = [each for each in result.rivals if each.meets and each.significant and each.ahead > result.indifference]
    for rival in better[: int(result.holds)]:
        yield f"Fresh trials show {_with_values(result, rival.candidate)} to be better: give the search more --runs."
    alike = [each for each in result.rivals if each.meets and not each.significant]
    if alike:
        named = "; ".join(_with_values(result, each.candidate) for each in alike[:4])
        more = f"; and {len(alike) - 4} more" if len(alike) > 4 else ""
        yield f"These trials cannot tell it from {named}{more}."
    if result.as_it_is is not None:
        own = "no number" if math.isnan(result.as_it_is.value) else measure.shown(result.as_it_is)
        lost = f", while errors take {_share(result.lost_as_it_is)} of the trials" * (
            result.lost_as_it_is > result.allowed
        )
        yield f"With the workbook's own decisions {measure.text} is {own}{lost}."
    yield from lost_sentences(result)
    yield from _without_number(result)
    yield from _ended(result)


def _missing(result: Optimised, best: str) -> Iterator[str]:
    """Yield what is said first where the best of the search misses a requirement by fresh trials."""
    measure = result.goal.measure
    others = [each for each in result.rivals if each.meets]
    if not others:
        yield (
            f"No candidate that was tried meets what is required. With {best}, which misses it the least, "
            f"{measure.text} is {measure.shown(result.estimate)}."
        )
        return
    yield (
        f"By fresh trials {best}, the best of the search with {measure.shown(result.estimate)}, misses what is "
        f"required; {_with_values(result, others[0].candidate)} meets it. More trials (-n) tell more."
    )


def _ended(result: Optimised) -> Iterator[str]:
    if result.ended:
        yield f"The search ended early, because {result.ended}: this is the best that was found by then."


def _without_number(result: Optimised) -> Iterator[str]:
    """Yield how many candidates give no number, and which texts nobody says."""
    from xlmc.montecarlo.number_text import count_text

    if result.numberless:
        count = result.numberless
        yield (
            f"{count_text(count)} candidate{'s give' if count > 1 else ' gives'} no number, since no trial was "
            "accepted, or the workbook is not possible with these values."
        )
    if result.indifferent:
        yield "All candidates give the same: the decisions do not change what is asked for."
    for name, text in result.missing_texts:
        texts = ", ".join(f"“{each}”" for each in result.run.labels.get(name, ()))
        yield f"With these decisions no trial of {name} says “{text}”; its texts are {texts}."


def lost_sentences(result: Optimised) -> Iterator[str]:
    """Yield what is to be known of trials that errors take; nothing where they take few of any candidate."""
    from xlmc.montecarlo.number_text import count_text

    most = _share(result.allowed)
    if not result.is_whole:
        yield (
            f"Errors in cells take {_share(result.lost)} of the trials of these decisions, and {most} is allowed. Mend "
            "the cells, filter such trials out, or allow them (--allow-lost)."
        )
    if result.excluded:
        count = len(result.excluded)
        yield (
            f"{count_text(count)} candidate{'s lose' if count > 1 else ' loses'} more than {most} of the trials to "
            "errors in cells, and cannot be the best: what the lost trials would be is not known."
        )
    better = [each for each in result.excluded if each.looks_better]
    if better:
        named = "; ".join(f"{_with_values(result, each.candidate)} (loses {_share(each.lost)})" for each in better[:4])
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
    shown = left.shown(each.estimate)
    if each.exact:
        return f"{requirement.text}: {'met' if each.chance > 0.5 else 'missed'}, {shown}."
    if each.chance <= 0.5:
        return f"{requirement.text} fails: {shown}."
    return f"{requirement.text} holds with {_percent(each.chance)} confidence: {shown}."


def _blocks(result: Optimised) -> Iterator[Block]:
    from xlmc.outputs.document.parts import Chart, Figure, Line, Lines, Table

    own = [result.run.model.workbook.content(each.cell).value for each in result.decisions]
    assert len(own) == len(result.best)
    rows = [
        (each.name, each.shown(value), each.units, str(each.cell))
        for each, value in zip(result.decisions, result.best, strict=True)
    ]
    if math.isnan(result.estimate.value):
        return
    title = "The best decisions" if result.holds else "The decisions"
    yield Table(title, ("Decision", "Value", "Units", "Cell"), tuple(rows), (1,))
    if result.requirements:
        stand = [
            (
                each.requirement.text,
                each.requirement.left.shown(each.estimate),
                "" if each.exact else _percent(each.chance),
            )
            for each in result.requirements
        ]
        yield Table("What is required", ("Requirement", "Found", "Holds with"), tuple(stand), (1, 2))
    if result.rivals:
        heads = (*(each.name for each in result.decisions), "Better by", "Significant", "Meets the requirements")
        heads = heads if result.requirements else heads[:-1]
        lines = [_rival_row(result, each)[: len(heads)] for each in result.rivals]
        yield Table("Others that come near", heads, tuple(lines), tuple(range(len(result.decisions) + 1)))
    if len(result.curve) > 1:
        (decision,) = result.decisions
        across = f"{decision.name}, {decision.units}" if decision.units else decision.name
        message = f"{result.goal.measure.text} for the values of {decision.name} that were tried"
        lines_drawn = Lines(
            (Line(_capital(result.goal.measure.text), result.curve),), _axis(result), now=result.best[0]
        )
        yield Figure(Chart("", across, lines_drawn, message), message)


def _axis(result: Optimised) -> str:
    measure = result.goal.measure
    return f"{measure.text}, {measure.units}" if measure.units else measure.text


def _rival_row(result: Optimised, each: Rival) -> tuple[str, ...]:
    from xlmc.montecarlo.statistics import Estimate

    form = result.goal.measure.form
    sign = "+" if each.ahead > 0.0 else ""
    ahead = f"{sign}{form.spread(Estimate(each.ahead, each.error))}"
    significant = "yes" if each.significant else "no"
    values = (one.shown(at) for one, at in zip(result.decisions, each.candidate, strict=True))
    return (*values, ahead, significant, "yes" if each.meets else "no")


def _meaning(result: Optimised) -> str:
    return (
        f"The candidates come from {result.how}, over random numbers that all share (seed {result.search_seed}); the "
        "numbers of the best come from fresh ones, so that being chosen does not make it look better. They are what "
        "`xlmc simulate` gives of the workbook with these decisions typed in. ± is the standard error "
        "(Monte Carlo error)."
    )


def _contents(result: Optimised, values: tuple[float, ...]) -> list[float | str | bool]:
    return [each.content(value) for each, value in zip(result.decisions, values, strict=True)]


def _as_json(result: Optimised, again: str) -> dict[str, object]:
    from xlmc.outputs.studies.json_numbers import estimate_json

    run = result.run
    return {
        "book": str(run.model.path),
        "goal": {"text": result.goal.measure.text, "maximise": result.goal.maximise},
        "decisions": [
            {"name": each.name, "cell": str(each.cell), "units": each.units, "value": each.content(value)}
            for each, value in zip(result.decisions, result.best, strict=True)
        ],
        "found": estimate_json(result.estimate),
        "as_it_is": None if result.as_it_is is None else estimate_json(result.as_it_is),
        "requirements": [
            {
                "text": each.requirement.text,
                "found": estimate_json(each.estimate),
                "probability": each.chance,
            }
            for each in result.requirements
        ],
        "indifference": result.indifference,
        "confidence": result.confidence,
        "others": [
            {
                "values": _contents(result, each.candidate),
                "better_by": {"value": each.ahead, "error": each.error},
                "significant": each.significant,
                "meets_requirements": each.meets,
                "probability_better": each.chance,
                "trials": each.trials,
            }
            for each in result.rivals
        ],
        "lost": {"share": result.lost, "as_it_is": result.lost_as_it_is, "allowed": result.allowed},
        "excluded": [
            {"values": _contents(result, each.candidate), "lost": each.lost, "looks_better": each.looks_better}
            for each in result.excluded
        ],
        "tried": result.tried,
        "trials_in_all": result.trials,
        "trials": run.trials,
        "seed": run.settings.seed,
        "search_seed": result.search_seed,
        "search": result.how,
        "ended_early": result.ended or None,
        "command": again,
    }
