from __future__ import annotations

import re
from dataclasses import replace

import pytest
from committed_books import CRASHES

from templates.description import Equation
from templates.vehicles import for_both, label_formula, names_a_vehicle, shown_label
from templates.writer.cached import computed
from xlmc.excel.address import Cell
from xlmc.excel.workbook.workbook import CellContent
from xlmc.montecarlo.model.loading import build_model

NAMED = [
    name
    for name in CRASHES
    if not name.startswith(("skid", "critical-speed-yaw")) and (not name.endswith("-si") or name == "planar-impact-si")
]
"""With one SI edition: all name the vehicles where the imperial ones do, as `test_editions.py` shows."""
NEW = ("Ford", 'Volvo "240"')


def test_a_pattern_becomes_one_equation_for_each_vehicle():
    pattern = Equation("V{j}_i", "V{j}i", "{who} speed", "ft/s", "<|->V{k}_f", "eq (<15|16>)", "<only here|>")
    first, second = for_both([pattern])
    assert (first.symbol, first.formula, first.reference, first.note) == ("V1_i", "V2_f", "eq (15)", "only here")
    assert (second.symbol, second.formula, second.reference, second.note) == ("V2_i", "-V1_f", "eq (16)", "")
    assert [shown_label(each.name, ("Truck", "Car")) for each in (first, second)] == ["Truck speed", "Car speed"]


def test_what_is_not_a_pattern_stays_as_it_is():
    plain = Equation("e_n", "e_n", "Restitution", "", "a<b", "eq (9)")
    assert for_both([plain]) == (plain,)


def test_a_label_is_a_formula_of_the_names():
    assert not names_a_vehicle("Restitution")
    assert label_formula("«1»") == "vehicle_1"
    assert label_formula("«2» delta-V") == 'vehicle_2&" delta-V"'
    assert label_formula('From «1» to «2»: "late"') == '"From "&vehicle_1&" to "&vehicle_2&": ""late"""'
    assert label_formula("«phase 2» length") == 'phase_2&" length"'
    assert shown_label("«phase 2» length", ("Braking", "Sliding")) == "Sliding length"
    long = label_formula("«1»" + "x" * 600)
    assert [len(text) for text in re.findall('"(x+)"', long)] == [255, 255, 90]


def texts_of(workbook):
    """The workbook with the formulas alone that show a text, and the numbers that the others show in their place."""
    sheets = {}
    for sheet in workbook.sheets.values():
        cells = {
            at: content if content.formula is None or isinstance(content.value, str) else CellContent(content.value)
            for at, content in sheet.cells.items()
        }
        sheets[sheet.name] = replace(sheet, cells=cells)
    return replace(workbook, sheets=sheets)


def with_names(workbook, names):
    """The workbook with other texts in cells of row 4 of Inputs, and with no saved value of a formula."""
    sheets = {}
    for sheet in workbook.sheets.values():
        cells = {
            at: content if content.formula is None else replace(content, value=None)
            for at, content in sheet.cells.items()
        }
        if sheet.name == "Inputs":
            typed = {at: names[content.value] for at, content in cells.items() if at[0] == 4 and content.value in names}
            assert len(typed) == len(names)
            cells |= {at: CellContent(name) for at, name in typed.items()}
        sheets[sheet.name] = replace(sheet, cells=cells)
    return replace(workbook, sheets=sheets)


@pytest.mark.parametrize("name", NAMED)
def test_a_new_name_shows_in_every_label_of_every_sheet(name, read, described, model_of):
    """Typed by a program that calculates nothing: xlmc reads the tables' labels all the same."""
    old = described[name].vehicles
    names = dict(zip(old, NEW, strict=False))
    book, before = with_names(read(name), names), model_of(name)
    contents = [content for sheet in book.sheets.values() for content in sheet.cells.values()]
    shown = [*computed(with_names(texts_of(read(name)), names)).values(), *(content.value for content in contents)]
    called = re.compile("|".join(old) if len(old) > 1 else r"Vehicle (?=speed)", re.IGNORECASE)
    assert not [text for text in shown if isinstance(text, str) and called.search(text)]
    after = build_model(book, before.path)
    for kind in ("assumptions", "forecasts", "filters", "checks"):
        expected = [renamed(each.name, names) for each in getattr(before, kind)]
        assert [each.name for each in getattr(after, kind)] == expected
    assert any(NEW[0] in each.name for each in after.forecasts)
    assert len(after.definitions.correlations) == len(before.definitions.correlations)


def renamed(label, names):
    for old, new in names.items():
        label = label.replace(old, new)
    return label


def test_phases_of_a_skid_are_called_as_one_likes(read, described, book_path):
    cells = [read("skid").content(Cell("Inputs", 4, column)).value for column in range(3, 9)]
    assert cells == [*described["skid"].vehicles] == [*("Surface 1", "Surface 2", "Surface 3", "Yaw", "Trip", "Roll")]
    names = {"Surface 1": "Braking", "Yaw": "On its side"}
    model = build_model(with_names(read("skid"), names), book_path["skid"])
    assert [a.name for a in model.assumptions][:8:2] == [
        *("Braking friction", "Surface 2 friction", "Surface 3 friction", "On its side: deceleration")
    ]
    assert "On its side: deceleration along the road" in computed(with_names(texts_of(read("skid")), names)).values()
