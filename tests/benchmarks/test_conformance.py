"""The conformance of a folder of workbooks, made here: what is counted, by cell and by shape, and what is printed."""

from __future__ import annotations

import pytest
import xlsxwriter


def written(path, formulas):
    """A workbook of these formulas, address -> (formula, saved value)."""
    with xlsxwriter.Workbook(path) as book:
        sheet = book.add_worksheet("S")
        sheet.write_column("A1", [1, 2, 3])
        for address, (formula, saved) in formulas.items():
            sheet.write_formula(address, formula, None, saved)


@pytest.fixture
def folder(tmp_path):
    inside = tmp_path / "books"
    inside.mkdir()
    written(
        inside / "good.xlsx",
        {"B1": ("=A1*2", 2), "B2": ("=A2*2", 4), "B3": ("=A3*2", 6), "C1": ("=RAND()", 0.5), "C2": ("=NOW()", 1)},
    )
    written(
        inside / "mixed.xlsx",
        {
            "B1": ("=A1*2", 2),
            "B2": ("=A2*2", 5),
            "C1": ("=CUBEVALUE(A1)", 7),
            "D1": ("=SUM(A1:A3)", 6),
            "E1": ('=CELL("width",A1)', 8),
        },
    )
    (inside / "locked.xlsx").write_bytes(b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1" + bytes(600))
    (inside / "broken.xlsx").write_bytes(b"no package")
    whole = (inside / "good.xlsx").read_bytes()
    (inside / "spoiled.xlsx").write_bytes(whole.replace(b"xl/worksheets", b"xl/worksheetz", 1))
    return tmp_path


def test_cells_and_shapes_are_counted(folder):
    from conformance import Status, check_folder

    result = check_folder(folder)
    assert {name: len(cells) for name, cells in result.books.items()} == {
        "good.xlsx": 3,
        "mixed.xlsx": 4,
        "locked.xlsx": 1,
    }
    assert result.damaged == ["broken.xlsx", "spoiled.xlsx"]
    assert result.cell_share() == 5 / 8
    assert result.cell_share(Status.DIFFERING) == 1 / 8
    assert result.shape_share() == 2 / 5  # good A*2 and SUM; A*2 of the mixed book has a cell that differs
    assert sorted(result.book_shares()) == [0.0, 0.5, 1.0]


def test_a_list_of_sizes_counts_a_refused_book(folder):
    from conformance import check_folder

    (folder / "INDEX.tsv").write_text("file\tformula_cells\nlocked.xlsx\t12\n", encoding="utf-8")
    assert len(check_folder(folder).books["locked.xlsx"]) == 12


def test_the_command_prints_both_figures_and_lists_the_rest(folder, capsys):
    from conformance import main

    assert main([str(folder)]) == 1
    done = capsys.readouterr()
    assert done.err == ""
    assert "8 cells: 5 matched (62.500%), 1 differing (12.500%), 2 unsupported (25.000%)" in done.out
    assert "5 shapes: 2 matched (40.000%)" in done.out
    apart = "without 1 cell (1 shape) of functions that docs/functions.md does not list"
    assert f"{apart}: 71.429% of cells and 50.000% of shapes match" in done.out
    assert "damaged, not counted: broken.xlsx" in done.out
    assert "refused, 1 shape: xlmc does not compute the function CUBEVALUE of Excel" in done.out
    assert "mixed.xlsx S!B2 =A2*2\n    Excel: 5.0\n    xlmc:  4.0" in done.out


def test_a_folder_where_all_match_ends_well(folder, capsys):
    from conformance import main

    (folder / "books" / "mixed.xlsx").unlink()
    (folder / "books" / "locked.xlsx").unlink()
    assert main([str(folder)]) == 0
    assert capsys.readouterr().err == ""
    with pytest.raises(SystemExit, match="2"):
        main([str(folder / "none")])
    assert "is no folder" in capsys.readouterr().err
