from __future__ import annotations

import pytest

from xlmc.excel.workbook.injection.part_numbers import (
    claimed_names,
    free_names,
    free_table_name,
    quoted,
    reached,
    rename_in_formula,
)

SHEETS = {"results": "Results (2)", "o'hara": "O'Hara (2)", "résumé": "Neu"}
TABLES = {"trials": "Trials_2"}


@pytest.mark.parametrize(
    ("formula", "expected"),
    [
        ("Results!$A$1:$B$2", "'Results (2)'!$A$1:$B$2"),
        ("RESULTS!A1", "'Results (2)'!A1"),
        ("'Results'!A1+results!A2", "'Results (2)'!A1+'Results (2)'!A2"),
        ("'O''Hara'!A1", "'O''Hara (2)'!A1"),
        ("Résumé!A1", "'Neu'!A1"),
        ("SUM(Results!A1,Other!A1)", "SUM('Results (2)'!A1,Other!A1)"),
        ("(Results!A1,Results!B1)", "('Results (2)'!A1,'Results (2)'!B1)"),
        ('"Results!A1"&Results!A1', "\"Results!A1\"&'Results (2)'!A1"),
        ('"say ""Results!"""', '"say ""Results!"""'),
        ("[1]Results!A1", "[1]Results!A1"),
        ("'[book.xlsx]Results'!A1", "'[book.xlsx]Results'!A1"),
        ("MyResults!A1+Results2!A1", "MyResults!A1+Results2!A1"),
        ("Results", "Results"),
        ("#REF!A1", "#REF!A1"),
        ("SUM(Trials[Speed])+Trials!A1", "SUM(Trials_2[Speed])+Trials!A1"),
        ("MyTrials[Speed]", "MyTrials[Speed]"),
        ("[#This Row]", "[#This Row]"),
        ("", ""),
    ],
)
def test_names_change_in_formulas(formula, expected):
    assert rename_in_formula(formula, SHEETS, TABLES) == expected


@pytest.mark.parametrize(
    ("wanted", "taken", "result"),
    [
        (["Results", "Trials"], ["Scene"], ["Results", "Trials"]),
        (["Results"], ["RESULTS"], ["Results (2)"]),
        (["Results"], ["results", "Results (2)"], ["Results (3)"]),
        (["Results", "Results (2)"], ["Results"], ["Results (2)", "Results (2) (2)"]),
        (["x" * 31], ["X" * 31], ["x" * 27 + " (2)"]),
    ],
)
def test_sheet_names_are_free(wanted, taken, result):
    assert list(free_names(wanted, taken).items()) == list(zip(wanted, result, strict=True))


@pytest.mark.parametrize(
    ("taken", "result"), [(set(), "Trials"), ({"trials"}, "Trials_2"), ({"trials", "trials_2"}, "Trials_3")]
)
def test_table_names_are_free(taken, result):
    assert free_table_name("Trials", taken) == result


def test_quoted():
    assert quoted("O'Hara") == "'O''Hara'"


def test_names_that_pointers_speak_of_are_claimed_whatever_the_case_of_their_part():
    pointer = b'<Relationship Id="a" Type="t/image" Target="../media/image7.png"/>'
    rels = b'<Relationships xmlns="x">' + pointer + b"</Relationships>"
    parts = {"[Content_Types].xml": b"<Types/>", "xl/drawings/a.xml": b"<a/>", "xl/drawings/_RELS/A.xml.rels": rels}
    assert claimed_names(parts) == {*parts, "xl/media/image7.png"}


class _Counted(dict):
    """Parts that count how often somebody goes through all their names."""

    passes = 0

    def __iter__(self):
        self.passes += 1
        return super().__iter__()


@pytest.mark.parametrize("search", [claimed_names, lambda parts: reached(parts, "xl/drawings/drawing1.xml")])
def test_the_names_of_the_parts_are_gone_through_a_few_times_however_many_charts_there_are(search):
    kind = "http://schemas.openxmlformats.org/officeDocument/2006/relationships/chart"
    pointers = "".join(
        f'<Relationship Id="rId{k}" Type="{kind}" Target="../charts/Chart{k}.xml"/>' for k in range(1, 401)
    )
    rels = f'<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">{pointers}</Relationships>'
    parts = _Counted({f"xl/charts/chart{k}.xml": b"<c/>" for k in range(1, 401)})
    types = b'<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types"/>'
    parts |= {"[Content_Types].xml": types, "xl/drawings/drawing1.xml": b"<d/>"}
    parts["xl/drawings/_rels/drawing1.xml.rels"] = rels.encode()
    assert {f"xl/charts/chart{k}.xml" for k in range(1, 401)} <= {*search(parts)}
    assert parts.passes < 12
