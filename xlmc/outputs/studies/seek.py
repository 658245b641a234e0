"""What `xlmc seek` found, as a document: at which input an answer has a given value."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import TYPE_CHECKING

from xlmc.montecarlo.number_text import count_text

if TYPE_CHECKING:
    from xlmc.analysis.studies.seek import Solutions
    from xlmc.montecarlo.definitions.forms import Form
    from xlmc.outputs.document.parts import Block
    from xlmc.outputs.study_report import StudyReport

__all__ = ["seek_report"]


def seek_report(result: Solutions) -> StudyReport:
    """Make the report."""
    from xlmc.outputs.document.parts import blocks_of
    from xlmc.outputs.study_report import StudyReport

    title = f"Where is {result.cell} equal to {result.form.number(result.to)}?"
    below = f"{result.workbook.name}: {result.cell} as a function of {result.by}, all else as in the workbook"
    return StudyReport(title, below, blocks_of(_blocks(result)), "Seek", partial(_as_json, result))


def _blocks(result: Solutions) -> Iterator[str | Block]:
    from xlmc.outputs.document.parts import Chart, Figure, Line, Lines, Table

    to, by = result.form.number(result.to), result.form_by
    span = f"from {by.rough(result.low)} to {by.rough(result.high)}"
    for low, high in result.throughout:
        yield f"{result.cell} is {to} wherever {result.by} is {_between(by, low, high)}, as finely as was looked."
    if not result.values.size:
        yield f"No value of {result.by} {span} makes {result.cell} equal to {to}."
        if result.base_answer is None and all(each != each for each in result.curve[1]):  # no NaN equals itself
            yield f"{result.cell} is no number for any value of {result.by} that was looked at."
    elif result.values.size == 1:
        yield f"{result.cell} is {to} where {result.by} is {_solved(by, result.values[0])}."
    elif result.values.size > 2 * len(result.throughout):
        many = f"{count_text(result.values.size)} values of {result.by} {span}"
        yield f"{many} make {result.cell} equal to {to}."
    base = [] if result.base is None else [("In the workbook", result.base, result.base_answer)]
    solved = zip(result.values.tolist(), result.answers.tolist(), strict=True)
    rows = [*base, *((f"Value {number}", *pair) for number, pair in enumerate(solved, 1))]
    texts = tuple((name, _solved(by, at), "" if is_ is None else _solved(result.form, is_)) for name, at, is_ in rows)
    if texts:
        yield Table("What was found", ("", str(result.by), str(result.cell)), texts, (1, 2))
    points = tuple((x, y) for x, y in zip(*map(list, result.curve), strict=True) if y == y)
    if len(points) > 1:
        wanted = tuple((at, result.to) for at in (points[0][0], points[-1][0]))
        drawn = Lines(
            (Line(str(result.cell), points), Line("Wanted", wanted)),
            str(result.cell),
            now=result.value,
            form_across=by,
            form_upwards=result.form,
        )
        message = f"{result.cell} for values of {result.by}, and the value it is to have"
        yield Figure(Chart("", str(result.by), drawn, message), message)


def _between(by: Form, low: float, high: float) -> str:
    """Write two ends of a range, in all digits where they read alike in few, as times of one day do."""
    ends = [by.rough(low), by.rough(high)]
    if ends[0] == ends[1]:
        ends = [_solved(by, low), _solved(by, high)]
    return f"from {ends[0]} to {ends[1]}"


def _solved(form: Form, value: float) -> str:
    """Write a number that was solved for, in twelve digits: to type it in gives the same answer."""
    from xlmc.montecarlo.definitions.stating import Kind
    from xlmc.montecarlo.number_text import number_text

    if form.kind is not Kind.DATE:
        before, after = form.affixes
        sign = "-" if value < 0.0 else ""
        return f"{sign}{before}{number_text(abs(form.factor * value), 12)}{after}"
    serial = number_text(value, 12)
    return f"{form.number(value)} ({serial})"


def _as_json(result: Solutions) -> dict[str, object]:
    from xlmc.montecarlo.statistics.estimate import finite

    return {
        "book": str(result.workbook.name),
        "cell": str(result.cell),
        "to": result.to,
        "by": str(result.by),
        "low": result.low,
        "high": result.high,
        "throughout": [list(ends) for ends in result.throughout],
        "base": {"by": result.base, "cell": result.base_answer},
        "values": [
            {"by": value, "cell": finite(answer)}
            for value, answer in zip(result.values.tolist(), result.answers.tolist(), strict=True)
        ],
    }
