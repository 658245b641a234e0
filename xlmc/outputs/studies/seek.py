"""What `xlmc seek` found, as a document: at which input an answer has a given value."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import TYPE_CHECKING

from xlmc.montecarlo.number_text import count_text

if TYPE_CHECKING:
    from xlmc.analysis.studies.seek import Found
    from xlmc.montecarlo.definitions.forms import Form
    from xlmc.outputs.document.parts import Block
    from xlmc.outputs.study_report import StudyReport

__all__ = ["seek_report"]


def seek_report(found: Found) -> StudyReport:
    """Make the report."""
    from xlmc.outputs.document.parts import blocks_of
    from xlmc.outputs.study_report import StudyReport

    title = f"Where is {found.cell} equal to {found.form.number(found.to)}?"
    below = f"{found.workbook.name}: {found.cell} as a function of {found.by}, all else as in the workbook"
    return StudyReport(title, below, blocks_of(_blocks(found)), "Seek", partial(_as_json, found))


def _blocks(found: Found) -> Iterator[str | Block]:
    from xlmc.outputs.document.parts import Chart, Figure, Line, Lines, Table

    to, by = found.form.number(found.to), found.form_by
    span = f"from {by.rough(found.low)} to {by.rough(found.high)}"
    for low, high in found.throughout:
        between = f"from {by.rough(low)} to {by.rough(high)}"
        yield f"{found.cell} is {to} wherever {found.by} is {between}, as finely as was looked."
    if not found.values.size:
        yield f"No value of {found.by} {span} makes {found.cell} equal to {to}."
        if found.base_answer is None and all(each != each for each in found.curve[1]):  # no NaN equals itself
            yield f"{found.cell} is no number for any value of {found.by} that was looked at."
    elif found.values.size == 1:
        yield f"{found.cell} is {to} where {found.by} is {_solved(by, found.values[0])}."
    elif found.values.size > 2 * len(found.throughout):
        many = f"{count_text(found.values.size)} values of {found.by} {span}"
        yield f"{many} make {found.cell} equal to {to}."
    base = [] if found.base is None else [("In the workbook", found.base, found.base_answer)]
    solved = zip(found.values.tolist(), found.answers.tolist(), strict=True)
    rows = [*base, *((f"Value {number}", *pair) for number, pair in enumerate(solved, 1))]
    texts = tuple((name, _solved(by, at), "" if is_ is None else _solved(found.form, is_)) for name, at, is_ in rows)
    if texts:
        yield Table("What was found", ("", str(found.by), str(found.cell)), texts, (1, 2))
    points = tuple((x, y) for x, y in zip(*map(list, found.curve), strict=True) if y == y)
    if len(points) > 1:
        wanted = tuple((at, found.to) for at in (points[0][0], points[-1][0]))
        drawn = Lines(
            (Line(str(found.cell), points), Line("Wanted", wanted)),
            str(found.cell),
            now=found.value,
            form_across=by,
            form_upwards=found.form,
        )
        said = f"{found.cell} for values of {found.by}, and the value it is to have"
        yield Figure(Chart("", str(found.by), drawn, said), said)


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


def _as_json(found: Found) -> dict[str, object]:
    from xlmc.montecarlo.statistics.estimate import finite

    return {
        "book": str(found.workbook.name),
        "cell": str(found.cell),
        "to": found.to,
        "by": str(found.by),
        "low": found.low,
        "high": found.high,
        "throughout": [list(ends) for ends in found.throughout],
        "base": {"by": found.base, "cell": found.base_answer},
        "values": [
            {"by": value, "cell": finite(answer)}
            for value, answer in zip(found.values.tolist(), found.answers.tolist(), strict=True)
        ],
    }
