"""Twenty further books, each with one thing that a person does to a workbook of Crystal Ball."""

from __future__ import annotations

import re

import pytest
from crystal_ball_book import Asked, Drawn, Tied, add_shapes, block, guid, object_guid, read_parts, save, write_parts
from simulated import simulated

from xlmc.analysis.results.record import make_record
from xlmc.engine.engines import ENGINES
from xlmc.excel.address import Cell
from xlmc.excel.workbook.reader import read_workbook
from xlmc.montecarlo.definitions.definitions_reader import read_definitions
from xlmc.montecarlo.model.loading import load

S = "Model"
A = Drawn(S, "$B$2", "Mass", "Normal", {"Mean": 100.0, "StdDev": 15.0})
B = Drawn(S, "$B$3", "Drag", "LogNormal", {"Mean": 0.7, "StdDev": 0.1, "Location": 0.0})
F = Asked(S, "$B$5", "Force")
CELLS = {"A2": "Mass", "A3": "Drag", "B2": 100, "B3": 0.7, "B5": "=B2*B3"}


def of(item):
    return f"CB_{object_guid(item).hex}"


def reference(item, *use):
    return f"CBCR_{guid(f'{object_guid(item)} {use}').hex}"


def by_reference(code, cell, **more):
    return Drawn(S, "$B$2", "Mass", "Normal", {"Mean": 100.0, "StdDev": 15.0}, references={code: cell}, **more)


def assumptions(result):
    return {a.name: (str(a.cell), {key: str(value) for key, value in a.parameters.items()}) for a in result.assumptions}


MASS = ("Model!B2", {"mean": "100.0", "std_dev": "15.0"})
DRAG = ("Model!B3", {"mean": "0.7", "std_dev": "0.1", "location": "0.0"})
BOTH = {"Mass": MASS, "Drag": DRAG}

TWO = by_reference(2, "$D$1", named_by="$A$2")
EXPRESSION = by_reference(3, "Model!$D$1/10+Model!$D$2")
GONE = by_reference(3, "$D$1")
ELSEWHERE = by_reference(3, "[1]Prices!$A$1")

BOOKS = {
    "blocks in another order": ({S: CELLS}, [[F], [B], [A]], {}, BOTH, ["Force"], []),
    "an apostrophe": (
        {"It's a 'model'": {"A1": 3, "A2": "=A1"}},
        [[Drawn("It's a 'model'", "$A$1", "x", "DPoisson", {"Rate": 3.0}), Asked("It's a 'model'", "$A$2", "y")]],
        {},
        {"x": ("'It''s a ''model'''!A1", {"rate": "3.0"})},
        ["y"],
        [],
    ),
    "letters of other scripts": (
        {"Käse 模型": {"A1": 3, "A2": "=A1"}},
        [[Drawn("Käse 模型", "$A$1", "μ", "DPoisson", {"Rate": 3.0}), Asked("Käse 模型", "$A$2", "σ")]],
        {},
        {"μ": ("'Käse 模型'!A1", {"rate": "3.0"})},
        ["σ"],
        [],
    ),
    "a row inserted above": (
        {S: {"B3": 100, "B4": 0.7, "B6": "=B3*B4"}},
        [[A, B, F]],
        {of(A): "Model!$B$3", of(B): "Model!$B$4", of(F): "Model!$B$6"},
        {"Mass": ("Model!B3", MASS[1]), "Drag": ("Model!B4", DRAG[1])},
        ["Force"],
        [],
    ),
    "a row inserted, parameters by reference": (
        {S: {**CELLS, "D1": 7, "D9": 100, "B2": 100}},
        [[TWO, F]],
        {reference(TWO, "ParmControlId", 2, "$D$1"): "Model!$D$9"},
        {"Mass": ("Model!B2", {"mean": "Model!D9", "std_dev": "15.0"})},
        ["Force"],
        [],
    ),
    "cells moved to another sheet": (
        {S: {**CELLS, "B5": "=Data!B2*B3"}, "Data": {"B2": 100}},
        [[A, B, F]],
        {of(A): "Data!$B$2"},
        {"Drag": DRAG, "Mass": ("Data!B2", MASS[1])},
        ["Force"],
        [],
    ),
    "an assumption deleted with its cell": ({S: CELLS}, [[A, B, F]], {of(A): "#REF!"}, {"Drag": DRAG}, ["Force"], []),
    "a forecast deleted with its cell": (
        {S: {**CELLS, "B6": "=B2"}},
        [[A, B, F, Asked(S, "$B$6", "Same")]],
        {of(F): "#REF!"},
        BOTH,
        ["Same"],
        [],
    ),
    "an assumption without its name": ({S: CELLS}, [[A, B, F]], {of(A): None}, {"Drag": DRAG}, ["Force"], []),
    "a parameter that is an expression": (
        {S: {**CELLS, "D1": 100, "D2": 5}},
        [[EXPRESSION, F]],
        {},
        {"Mass": ("Model!B2", {"mean": "100.0", "std_dev": "Model!B2#std dev"})},
        ["Force"],
        [],
    ),
    "a parameter whose cell is gone": (
        {S: {**CELLS, "B6": "=B3"}},
        [[GONE, B, F, Asked(S, "$B$6", "Same")]],
        {reference(GONE, "ParmControlId", 3, "$D$1"): "Model!#REF!"},
        {"Drag": DRAG},
        ["Same"],
        ["has lost its cell"],
    ),
    "a parameter without its name": (
        {S: {**CELLS, "B6": "=B3"}},
        [[GONE, B, F, Asked(S, "$B$6", "Same")]],
        {reference(GONE, "ParmControlId", 3, "$D$1"): None},
        {"Drag": DRAG},
        ["Same"],
        ["is missing"],
    ),
    "a parameter of another workbook": (
        {S: {**CELLS, "B6": "=B3"}},
        [[ELSEWHERE, B, F, Asked(S, "$B$6", "Same")]],
        {},
        {"Drag": DRAG},
        ["Same"],
        ["stands for"],
    ),
    "a formula typed over an assumption": (
        {S: {**CELLS, "B2": "=50*2", "B6": "=B3"}},
        [[A, B, F, Asked(S, "$B$6", "Same")]],
        {},
        {"Drag": DRAG},
        ["Same"],
        ["holds a formula"],
    ),
    "a text typed over an assumption": (
        {S: {**CELLS, "B2": "none", "B6": "=B3"}},
        [[A, B, F, Asked(S, "$B$6", "Same")]],
        {},
        {"Drag": DRAG},
        ["Same"],
        ["holds the text 'none'"],
    ),
    "a name that goes by a formula": (
        {S: CELLS},
        [[Drawn(S, "$B$2", "=A9", "DPoisson", {"Rate": 3.0}, named_by='Model!$A$2&" of car "&1'), F]],
        {},
        {"Mass of car 1": ("Model!B2", {"rate": "3.0"})},
        ["Force"],
        [],
    ),
    "no hidden sheet": ({S: CELLS}, [[A, B, F]], {}, BOTH, ["Force"], []),
    "one name for all": (
        {S: {**CELLS, "B6": "=B5"}},
        [[A, Drawn(S, "$B$3", "mass", "DPoisson", {"Rate": 3.0}), F, Asked(S, "$B$6", "Force")]],
        {},
        {"Mass": MASS, "mass (Model!B3)": ("Model!B3", {"rate": "3.0"})},
        ["Force", "Force (Model!B6)"],
        [],
    ),
}


@pytest.mark.parametrize("title", BOOKS)
def test_a_book(title, tmp_path):
    cells, blocks, names, drawn, answers, refused = BOOKS[title]
    path = tmp_path / "book.xlsx"
    comments = [(next(iter(cells)), "C1", "a comment\nof two lines"), (next(iter(cells)), "B2", "<b>&amp;</b>")]
    save(path, cells, blocks, names=names, hide=title != "no hidden sheet", comments=comments)
    result = read_definitions(read_workbook(path), ENGINES)
    assert not result.problems
    assert assumptions(result) == drawn
    assert [f.name for f in result.forecasts] == answers
    assert len(result.refused) == len(refused)
    for error, why in zip(result.refused, refused, strict=True):
        assert why in error.message
    run = simulated(load(path), 100)
    assert all(run[name].values.size == 100 for name in answers)
    assert make_record(run).rows("assumptions")


def test_a_sheet_that_was_copied_has_assumptions_of_its_own(tmp_path):
    """Excel copies the pictures and the names, GUIDs and all, where Crystal Ball is not loaded."""
    path = tmp_path / "book.xlsx"
    tied = Tied(S, "", A, B, 0.5)
    save(path, {S: CELLS, "Model (2)": CELLS}, [[A, B, F, tied]])
    parts = read_parts(path)
    add_shapes(parts, 3, [("CB_Block_7.0.0.0_x003a_1", block([A, B, F, tied]))])
    copied = [
        f'<definedName name="{of(item)}" localSheetId="2" hidden="1">\'Model (2)\'!{item.cell}</definedName>'
        for item in (A, B, F)
    ]
    copied.append(f'<definedName name="CBx_Sheet_Guid" localSheetId="2" hidden="1">"\'{guid(S)}"</definedName>')
    own = re.compile(rb'<definedName name="CBx_Sheet_Guid" localSheetId="2"[^>]*>[^<]*</definedName>')
    book = own.sub(b"", parts["xl/workbook.xml"])
    parts["xl/workbook.xml"] = book.replace(b"</definedNames>", "".join(copied).encode() + b"</definedNames>")
    write_parts(path, parts)
    result = read_definitions(read_workbook(path), ENGINES)
    assert [(a.name, str(a.cell)) for a in result.assumptions] == [
        ("Mass", "Model!B2"),
        ("Drag", "Model!B3"),
        ("Mass ('Model (2)'!B2)", "'Model (2)'!B2"),
        ("Drag ('Model (2)'!B3)", "'Model (2)'!B3"),
    ]
    assert [(c.first, c.second) for c in result.correlations] == [
        ("Mass", "Drag"),
        ("Mass ('Model (2)'!B2)", "Drag ('Model (2)'!B3)"),
    ]


def test_what_was_lost_or_is_too_old_is_said_with_the_cure(tmp_path):
    path = tmp_path / "book.xlsx"
    save(path, {S: CELLS}, [[A, B, F]])
    parts = read_parts(path)
    write_parts(
        path,
        {
            name: data
            for name, data in parts.items()
            if not name.endswith((".vml", "sheet2.xml.rels", "sheet1.xml.rels"))
        },
    )
    (lost,) = read_definitions(read_workbook(path), ENGINES).problems
    assert "are lost" in lost.message
    assert "save it as .xlsx" in lost.hint
    old = parts["xl/workbook.xml"].decode()
    names = "".join(f'<definedName name="_{name}">"1+2"</definedName>' for name in ("ZA0", "ZA100", "ZF100"))
    old = re.sub("<definedNames>.*</definedNames>", f"<definedNames>{names}</definedNames>", old)
    kept = {
        name: data for name, data in parts.items() if not name.endswith((".vml", ".xml.rels")) or "workbook" in name
    }
    write_parts(path, {**kept, "xl/workbook.xml": old.replace("CB_DATA_", "Other").encode()})
    (older,) = read_definitions(read_workbook(path), ENGINES).problems
    assert "Crystal Ball 2000 or older" in older.message
    assert "Crystal Ball 7 or later" in older.hint


def test_what_a_scenario_types_into_cells_leaves_the_dialogs_as_they_are(tmp_path):
    from xlmc.montecarlo.definitions.scenarios import Typed
    from xlmc.montecarlo.model.applied_changes import applied
    from xlmc.montecarlo.simulation.simulate import simulate

    path, edited = tmp_path / "book.xlsx", tmp_path / "edited.xlsx"
    wide = by_reference(3, "$D$1")
    save(path, {S: CELLS | {"D1": 15}}, [[wide, B, F]])
    save(edited, {S: CELLS | {"D1": 30}}, [[wide, B, F]])
    model = load(path)
    typed = Typed(Cell(S, 1, 4), 30)
    for result in (applied(model, [typed]), applied(applied(model, [Typed(Cell(S, 1, 4), 7)]), [typed])):
        run, known, before = (simulate(each, trials=500)["Force"] for each in (result, load(edited), model))
        assert run.values.tolist() == known.values.tolist() != before.values.tolist()
