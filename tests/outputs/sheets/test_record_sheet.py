from __future__ import annotations

import re

import pytest

from xlmc.analysis.results.record import make_record
from xlmc.outputs.document.cells import number_format


@pytest.fixture(scope="session")
def read_back(run, opened):
    """What a program reads of the sheet Record by its keys: entries, and the rows of tables."""
    sheet = opened(run, "Record", command="xlmc simulate book.xlsx -n 5000")["Record"]
    entries, tables, keys = {}, {}, []
    for row in sheet.iter_rows():
        key = row[0].value
        if key is None:
            keys = [(cell.value, cell.column) for cell in row[1:] if cell.value is not None]
            columns = keys if row[1].value in ("name", "first", "message", "kind", "cell") else None
            tables["columns"] = columns or tables.get("columns")
        elif indexed := re.fullmatch(r"(\w+)\[(\d+)\]", key):
            values = {name: sheet.cell(row[0].row, column).value for name, column in tables["columns"]}
            entries.setdefault(indexed[1], []).append(values)
        elif "." in key:
            entries[key] = row[2].value
    return entries


def test_every_entry_is_read_back_by_its_key(run, read_back):
    record = make_record(run, "xlmc simulate book.xlsx -n 5000")
    for section in record.sections:
        for entry in section.entries:
            expected = "–" if entry.value in (None, "") else entry.value
            assert read_back[f"{section.key}.{entry.key}"] == expected


def test_every_row_of_a_table_is_read_back(run, read_back):
    record = make_record(run)
    for section in record.sections:
        for expected, result in zip(record.rows(section.key), read_back.get(section.key, []), strict=True):
            assert result == {key: "–" if value in (None, "") else value for key, value in expected.items()}


def test_commands_and_hashes_are_in_a_fixed_width_font(book):
    sheet = book["Record"]
    fonts = {sheet.cell(row, 1).value: sheet.cell(row, 3).font.name for row in range(1, sheet.max_row + 1)}
    assert fonts["run.repeat"] == fonts["run.fingerprint"] == fonts["file.sha256"] == "Consolas"
    assert fonts["sampling.seed"] != "Consolas"


def test_keys_are_folded_away_and_not_printed(book):
    sheet = book["Record"]
    assert sheet.column_dimensions["A"].hidden
    assert sheet.print_area.startswith("'Record'!$B$1:")
    last = int(sheet.print_area.rpartition("$")[2])
    assert sheet.cell(last - 1, 2).value == "Vector instructions"  # the model's names and cells are not printed


def test_empty_tables_say_none(book, row_of):
    sheet = book["Record"]
    row = next(cell.row for cell in sheet["A"] if cell.value == "correlations")
    assert sheet.cell(row + 1, 2).value == "None"


@pytest.mark.parametrize(
    ("value", "shown"),
    [
        *((20_000, "#,##0"), (4960.0, "#,##0"), (0.0172, "General"), (1 / 3, "#,##0.000000")),
        *((0.00091935194566, "#,##0.0000000"), (12.39573907, "#,##0.0000")),
    ],
)
def test_numbers_show_six_digits_at_most(value, shown):
    assert number_format(value) == shown


def test_counts_have_separators_and_seeds_none(book):
    sheet = book["Record"]
    formats = {sheet.cell(row, 1).value: sheet.cell(row, 3).number_format for row in range(1, sheet.max_row + 1)}
    assert formats["sampling.trials"] == "#,##0"
    assert formats["sampling.seed"] == "General"
