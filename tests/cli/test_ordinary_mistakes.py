"""A workbook of one's own with one ordinary mistake: one line with the cell, and the right cure; nothing is written."""

from __future__ import annotations

import pytest
from beam_books import beam

MISTAKES = {
    "a misspelt distribution": (
        {"Inputs!C2": "Triangel"},
        "Inputs!C2",
        "'Triangel' is not a distribution",
        "Did you mean Triangular?",
    ),
    "low above high": ({"Inputs!D4": 990}, "Inputs!D4", "Low (990) is above High (950)", "Exchange the two"),
    "the likeliest outside": (
        {"Inputs!E2": 70},
        "Inputs!E2",
        "Likeliest (70) is above High (60)",
        "Give a value from Low to High",
    ),
    "a negative standard deviation": (
        {"Inputs!H3": -20},
        "Inputs!H3",
        "Std dev (-20) must be above 0",
        "Give a positive number",
    ),
    "a parameter left out": (
        {"Inputs!H3": None},
        "Inputs!H3",
        "Normal needs Std dev, and this cell is blank",
        "Type a number",
    ),
    "a parameter of another family": ({"Inputs!D3": 250}, "Inputs!D3", "Normal has no Low", "Clear the cell"),
    "a text for a number": ({"Inputs!F4": "950 cm3"}, "Inputs!F4", "High holds the text '950 cm3'", "Type a number"),
    "a number typed as text": (
        {"Inputs!F4": "950"},
        "Inputs!F4",
        "High holds the text '950'",
        "Type it again as a number",
    ),
    "a decimal comma": ({"Inputs!D5": "5,9"}, "Inputs!D5", "Low holds the text '5,9'", "such as 5.9"),
    "a text for a value": (
        {"Inputs!B4": "about 900"},
        "Inputs!B4",
        "The assumption cell holds the text 'about 900'",
        "Type a number",
    ),
    "a formula as an assumption": (
        {"Inputs!B4": "=30*30"},
        "Inputs!B4",
        "The assumption cell holds a formula",
        "Replace the formula by its value",
    ),
    "two assumptions of one name": (
        {"Inputs!A3": "Load"},
        "Inputs!A3",
        "Two rows define the assumption 'Load', this one and Inputs!A2",
        "Give each row its own name",
    ),
    "an assumption without a name": ({"Inputs!A3": None}, "Inputs!A3", "Name is blank", "Fill in Name"),
    "plus-minus of a text": (
        {"Inputs!B5": "six", "Inputs!D5": None, "Inputs!F5": None, "Inputs!J5": 1},
        "Inputs!B5",
        "The assumption cell holds the text 'six'",
        "Type a number",
    ),
    "percent of 0": (
        {"Inputs!B5": 0, "Inputs!D5": None, "Inputs!F5": None, "Inputs!K5": 5},
        "Inputs!K5",
        "± % of a value of 0 is no distance",
        "Give the distance itself under ±",
    ),
    "a negative distance": (
        {"Inputs!D5": None, "Inputs!F5": None, "Inputs!J5": -1},
        "Inputs!J5",
        "± must be above 0",
        "Give a positive number",
    ),
    "plus-minus and ends": ({"Inputs!J5": 1}, "Inputs!D5", "± and Low are both given", "Clear one of them"),
    "neither yes nor no": ({"Inputs!M5": "maybe"}, "Inputs!M5", "Frozen holds 'maybe'", "Type TRUE or FALSE"),
    "a low that is an error": (
        {"Inputs!D5": "=1/0"},
        "Inputs!D5",
        "Low of 'span' is the error #DIV/0!",
        "Correct the cell's formula",
    ),
    "a heading misspelt": (
        {"Inputs!F1": "Hihg"},
        "Inputs!F1",
        "The column 'Hihg' is not read: did you mean High?",
        "Rename the column High",
    ),
    "a heading missing": (
        {"Answers!A1": "Answer"},
        "Answers!A1",
        "The table xlmc_forecasts has no column Name",
        "Add a column Name",
    ),
    "a forecast at an empty cell": (
        {"Answers!B2": "=Model!B9"},
        "Model!B9",
        "The forecast cell is blank",
        "Point to the cell with the result",
    ),
    "a forecast at a text": (
        {"Answers!B2": "=Model!A3", "Model!A3": "stress"},
        "Model!A3",
        "The forecast cell holds the text 'stress'",
        "Point to the cell with the result",
    ),
    "a forecast of a sheet that is missing": (
        {"Answers!B2": "=Modell!B3"},
        "Answers!B2",
        "There is no worksheet 'Modell'",
        "Did you mean Model?",
    ),
    "a forecast of several cells": (
        {"Answers!B2": "=Model!B3:B4"},
        "Answers!B2",
        "Model!B3:B4 is more than one cell",
        "Write one cell",
    ),
    "a forecast without a cell": (
        {"Answers!B2": None},
        "Answers!A2",
        "Nothing says which cell 'stress' is",
        "Fill in Cell with a reference",
    ),
    "a cell of no sheet": (
        {"Answers!B2": "B3"},
        "Answers!B2",
        "'B3' names no sheet",
        "Write the formula =B3, or name the sheet",
    ),
    "two forecasts of one name": (
        {"Answers!A3": "stress"},
        "Answers!A3",
        "Two rows define the forecast 'stress'",
        "Give each row its own name",
    ),
    "a range above 100": (
        {"Answers!E2": 510},
        "Answers!E2",
        "Range % (510) must be above 0 and below 100",
        "in percent, such as 51",
    ),
    "a threshold that varies": (
        {"Answers!D2": "=strength"},
        "Answers!D2",
        "Threshold depends on the assumption 'strength', and is one for all trials",
        "Compare in a cell of its own",
    ),
    "a filter that is no test": (
        {"Answers!C7": None},
        "Model!B4",
        "The filter 'stands' has no limit",
        "Fill in At least",
    ),
    "limits that contradict": (
        {"Answers!D7": -1},
        "Answers!C7",
        "At least (0) and At most (-1) contradict each other",
        "Correct one of them",
    ),
    "Use that varies": (
        {"Answers!F7": "=load>30"},
        "Answers!F7",
        "Use depends on the assumption 'load', and is one for all trials",
        "into the cell that is tested",
    ),
    "Use that is an error": ({"Answers!F7": "=1/0"}, "Answers!F7", "Use has never been calculated", "xlmc calculate"),
    "Use that is a word": ({"Answers!F7": "perhaps"}, "Answers!F7", "Use holds 'perhaps'", "Type TRUE or FALSE"),
    "a correlation of a name that is missing": (
        {"Answers!B11": "spam"},
        "Answers!B11",
        "There is no assumption 'spam'",
        "Did you mean span?",
    ),
    "a correlation above 1": (
        {"Answers!C11": 3},
        "Answers!C11",
        "Correlation (3) must lie between -1 and 1",
        "from -1 to 1",
    ),
    "a correlation with itself": (
        {"Answers!B11": "load"},
        "Answers!B11",
        "'load' is correlated with itself",
        "Name two different assumptions",
    ),
    "a correlation that varies": (
        {"Answers!C11": "=span/10"},
        "Answers!C11",
        "The rank correlation of 'load' and 'span' varies",
        "type it",
    ),
    "an unknown setting": (
        {"Answers!A15": "Trails"},
        "Answers!A15",
        "There is no setting 'Trails'",
        "Did you mean Trials?",
    ),
    "trials that are no number": ({"Answers!B15": "many"}, "Answers!B15", "Trials is 'many'", "Type it like 200000"),
    "half a trial": ({"Answers!B15": 0.5}, "Answers!B15", "Trials must be a whole number", "Correct the number"),
    "a circular reference": (
        {"Model!B2": "=B3*2"},
        "Model!B2",
        "The cells need each other in a circle: Model!B2 → Model!B3 → Model!B2",
        "Break the circle",
    ),
    "a name that is missing": (
        {"Model!B2": "=laod*span/4"},
        "Model!B2",
        "There is no name 'laod'",
        "Did you mean 'load'?",
    ),
    "a sheet that is missing": (
        {"Model!B2": "=Input!B2*span/4"},
        "Model!B2",
        "There is no sheet 'Input'",
        "Did you mean 'Inputs'?",
    ),
    "a function that is missing": (
        {"Model!B2": "=SQUARE(load)"},
        "Model!B2",
        "The function SQUARE is not known to xlmc",
        "",
    ),
    "a function of VBA": (
        {"Model!B2": "=BeamMoment(load,span)"},
        "Model!B2",
        "The function BEAMMOMENT is not known to xlmc",
        "",
    ),
    "a bracket missing": (
        {"Model!B2": "=(load*span/4"},
        "Model!B2",
        "The formula cannot be read from the marked character on",
        "Check brackets",
    ),
    "an argument missing": ({"Model!B2": "=POWER(load)"}, "Model!B2", "POWER has 1 argument", "it takes 2"),
    "data that are a text": (
        {
            "Inputs!C2": "Custom",
            "Inputs!D2": None,
            "Inputs!E2": None,
            "Inputs!F2": None,
            "Inputs!I2": "=Model!G1:G3",
            "Model!G1": 30,
            "Model!G2": "40 kN",
            "Model!G3": 50,
        },
        "Model!G2",
        "The data cell holds the text '40 kN'",
        "Type a number",
    ),
    "data that are missing": (
        {"Inputs!C2": "Custom", "Inputs!D2": None, "Inputs!E2": None, "Inputs!F2": None},
        "Inputs!I2",
        "Custom needs Data, a range of cells",
        "Name the range that holds them",
    ),
}


@pytest.mark.parametrize(("changes", "where", "message", "cure"), MISTAKES.values(), ids=MISTAKES)
def test_a_mistake_is_one_line_with_its_cell_and_cure(xlmc, tmp_path, changes, where, message, cure):
    book = beam(tmp_path / "beam.xlsx", changes)
    done = xlmc("simulate", book)
    first, *marked = done.err.splitlines()
    assert done.code == 2
    assert first.startswith(f"xlmc: {where}: {message}")
    assert cure in first
    assert not marked or (len(marked) < 3 and marked[0].startswith("    ="))  # the formula, and a mark under its fault
    assert done.out == ""
    assert [path.name for path in tmp_path.iterdir()] == ["beam.xlsx"]


REMARKS = {
    "probabilities that do not sum to 1": (
        {
            **dict.fromkeys(("Inputs!D2", "Inputs!E2", "Inputs!F2")),
            "Inputs!C2": "Custom",
            "Inputs!I2": "=Model!G1:H3",
            "Model!G1": 30,
            "Model!H1": 0.5,
            "Model!G2": 40,
            "Model!H2": 0.3,
            "Model!G3": 50,
            "Model!H3": 0.1,
        },
        0,
        "note: Model!H1: The probabilities sum to 0.9, not to 1: each is taken as its share of 0.9",
    ),
    "a reference that was deleted": (
        {"Model!B2": "=#REF!*span"},
        1,
        "warning: no trial was accepted: every trial was lost to an error in a cell",
    ),
    "every row frozen": (
        {f"Inputs!M{row}": True for row in (2, 3, 4, 5)},
        0,
        "note: Model!B3: Nothing varies: no assumption is drawn, as when all are Frozen",
    ),
}


@pytest.mark.parametrize(("changes", "code", "remark"), REMARKS.values(), ids=REMARKS)
def test_what_may_be_meant_is_run_and_told(xlmc, tmp_path, changes, code, remark):
    done = xlmc("simulate", beam(tmp_path / "beam.xlsx", changes))
    assert done.code == code
    assert remark in done.err


def test_the_workbook_without_a_mistake_runs(xlmc, tmp_path):
    done = xlmc("simulate", beam(tmp_path / "beam.xlsx", {}))
    assert (done.code, done.err) == (0, "")
