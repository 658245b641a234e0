"""`xlmc_correlation_matrix`: a square table of names beside the list of pairs."""

from __future__ import annotations

import pytest
from workbook_files import workbook_of

TABLES = {
    "xlmc_assumptions": "S!A1:D4",
    "xlmc_forecasts": "S!A6:B7",
    "xlmc_correlation_matrix": "S!F1:I4",
    "xlmc_correlations": "S!F6:H7",
}


def written(path, matrix, pair=("a", "c", 0.2)):
    rows = [["Name", "Value", "Low", "High", None, *matrix[0]]]
    rows += [[name, 1.0, 0.0, 2.0, None, *line] for name, line in zip("abc", matrix[1:], strict=True)]
    rows += [[], ["Name", "Value", None, None, None, "First", "Second", "Correlation"]]
    rows += [["y", "=SUM(B2:B4)", None, None, None, *pair]]
    workbook_of({"S": rows}, TABLES).save(path)
    return path


def test_a_half_or_a_whole_matrix_is_read_beside_the_pairs(xlmc, tmp_path):
    lower = [["Name", "a", "b", "c"], ["a", 1, None, None], ["b", 0.5, 1, None], ["c", None, -0.3, 1]]
    whole = [["Name", "a", "b", "c"], ["a", 1, 0.5, None], ["b", 0.5, 1, -0.3], ["c", None, -0.3, 1]]
    outcomes = [xlmc("check", written(tmp_path / "case.xlsx", each)) for each in (lower, whole)]
    assert [each.code for each in outcomes] == [0, 0]
    assert outcomes[0].out == outcomes[1].out
    lines = [line.split()[:3] for line in outcomes[0].out.partition("Rank correlations")[2].splitlines()]
    assert [line for line in lines if len(line) == 3 and line[0] in "abc"] == [
        ["a", "c", "0.2"],
        ["a", "b", "0.5"],
        ["b", "c", "-0.3"],
    ]


MISTAKES = {
    "halves differ": (
        [["Name", "a", "b", "c"], ["a", 1, 0.5, None], ["b", 0.4, 1, None], ["c"]],
        "S!G3",
        "two correlations",
    ),
    "no such name": ([["Name", "a", "b", "d"], ["a"], ["b", 0.4], ["c"]], "S!I1", "There is no assumption 'd'"),
    "a diagonal": ([["Name", "a", "b", "c"], ["a", 0.9], ["b"], ["c"]], "S!G2", "with itself is 1"),
    "too large": ([["Name", "a", "b", "c"], ["a"], ["b", 1.5], ["c"]], "S!G3", "between -1 and 1"),
    "also a pair": ([["Name", "a", "b", "c"], ["a"], ["b"], ["c", 0.5]], "S!G4", "are correlated here and in"),
}


@pytest.mark.parametrize(("matrix", "where", "message"), MISTAKES.values(), ids=MISTAKES)
def test_a_mistake_names_its_cell(xlmc, tmp_path, matrix, where, message):
    padded = [[*line, *[None] * (4 - len(line))] for line in matrix]
    outcome = xlmc("check", written(tmp_path / "case.xlsx", padded))
    assert outcome.code == 2
    assert where in outcome.err
    assert message in outcome.err
