"""What sections say of a run, as the blocks that all outputs write."""

from __future__ import annotations

import pytest

from xlmc.montecarlo.statistics import proportion
from xlmc.outputs.document.content.answers import answer_blocks, answer_tables
from xlmc.outputs.document.content.checks import check_blocks
from xlmc.outputs.document.content.evidence import evidence_blocks
from xlmc.outputs.document.content.filters import count_blocks, filter_blocks
from xlmc.outputs.document.content.notices import notice_blocks
from xlmc.outputs.document.measured import Measured
from xlmc.outputs.document.parts import Bullets, Paragraph, Table, cell_text


def tables(blocks):
    return {each.caption: each for each in blocks if isinstance(each, Table)}


def row_of(table, name):
    return next(row for row in table.rows if row[0] == name)


def test_the_answer_can_be_read_alone(run):
    blocks = [*answer_blocks(run, run.results)]
    looks = [each.look for each in blocks if isinstance(each, Paragraph)]
    assert looks[-2:] == ["meaning", "small"]
    table, above = (each for each in blocks if isinstance(each, Table))
    for name, result in run.results.items():
        row = row_of(table, name)
        results = [each.estimate for each in row if isinstance(each, Measured)]
        assert results[:4] == [result.mean, result.standard_deviation, *result.central()]
        if result.definition.threshold is not None:
            *_, limit, share = row_of(above, name)
            assert limit.value == result.definition.threshold
            assert share.estimate == result.statistics.probability_above
        assert f"{name}: " in "".join(text for each in blocks if isinstance(each, Bullets) for text in each.texts)


def test_a_report_of_one_forecast_tells_of_no_other(run):
    messages, other = [*run.results][:2]
    blocks = [*answer_blocks(run, [messages])]
    tables = [each for each in blocks if isinstance(each, Table)]
    assert [[row[0] for row in table.rows] for table in tables] == [[messages]] * len(tables)
    assert not any(text.startswith(other) for each in blocks if isinstance(each, Bullets) for text in each.texts)


def test_a_sheet_has_the_same_numbers_and_how_many_trials(run):
    counted, shown = next(answer_tables(run)), next(each for each in answer_blocks(run, run.results) if is_table(each))
    for row in counted.rows:
        numbers = [each for each in row_of(shown, row[0]) if isinstance(each, Measured)]
        assert [each for each in row if isinstance(each, Measured)] == numbers[:4]
        assert row[2].value == run.results[row[0]].statistics.trials


def test_a_yes_no_answer_above_its_threshold_is_told_as_a_yes(make):
    cells = {"A1": 1.0, "B1": "=A1>0.5", "B2": "=A1"}
    messages = [make.forecast("yes", "B1", threshold=0.5), make.forecast("number", "B2", threshold=0.5)]
    result = make.simulate(cells, [make.uniform("a", "A1", 0, 1)], messages)
    above = tables(answer_blocks(result, result.results))["Values above a threshold."]
    assert [row[0] for row in above.rows] == ["number"]


def is_table(block):
    return isinstance(block, Table)


def test_filters_say_what_they_ask_and_rejected(run):
    full, brief = (tables(filter_blocks(run, full=each)) for each in (True, False))
    rejected, messages = (
        full["Trials rejected by the filters."],
        brief["The filters and how many trials each rejected."],
    )
    for index, each in enumerate(run.model.filters):
        row, short = (row_of(table, f"{index + 1}. {each.name}") for table in (rejected, messages))
        assert row[2].value == short[3].value == run.tally.rejected[index]
        assert row[3].estimate == short[4].estimate == proportion(int(run.tally.rejected[index]), run.trials)
        assert [each.value for each in row[6:] if each] == [*run.tally.together[index]][:index] + [
            *run.tally.together[index]
        ][index + 1 :]
    assert set(full) >= {"Filters: a trial is accepted when all hold.", "Errors in cells."}
    assert not set(brief) & {"Errors in cells."}


def test_trials_are_counted(run):
    (table,) = tables(count_blocks(run)).values()
    counts = {row[0]: row[1].value for row in table.rows}
    assert counts == {"Run": run.trials, "Accepted": run.accepted, "Lost to errors in cells": run.error_trials}
    assert row_of(table, "Accepted")[2].estimate == run.acceptance


def test_weighted_trials_have_evidence_and_effective_trials(weighted):
    (table,) = tables(count_blocks(weighted)).values()
    assert row_of(table, "Effective")[1].value == round(weighted.weighting.effective)
    result = tables(evidence_blocks(weighted, weighted.results, full=True))
    brief = tables(evidence_blocks(weighted, weighted.results, full=False))
    moved, means = (
        result["What each item moves."],
        brief["What each item of evidence moves: the means of the forecasts."],
    )
    assert {cell_text(row[3]) for row in moved.rows} == {cell_text(row[2]) for row in means.rows}
    assert "The rows of xlmc_evidence." in result


@pytest.mark.parametrize("make", [check_blocks, lambda run: evidence_blocks(run, run.results, full=True)])
def test_what_a_workbook_lacks_has_no_blocks(run, make):
    assert [*make(run)] == []


def test_each_notice_is_a_paragraph(run):
    assert [each.text for each in notice_blocks(run)] == [str(each) for each in run.notices]
