from __future__ import annotations

import shutil
import sys

import committed_books
import openpyxl
import pytest

from xlmc.cli.new import templates

sys.path.append(str(committed_books.ROOT))

from templates.build import TEMPLATES as DESCRIBED

TEMPLATES = sorted(DESCRIBED, key=lambda name: (DESCRIBED[name].group, DESCRIBED[name].rung))
"""Those for crashes, then other fields; in each group the simplest first."""


def test_lists_the_templates(xlmc):
    outcome = xlmc("new")
    assert outcome.code == 0
    names = [line.split()[0] for line in outcome.out.splitlines() if line.startswith(" ") and line.strip()]
    assert [name for name in names if name in TEMPLATES] == TEMPLATES
    rows = [line for line in outcome.out.splitlines() if line.strip().partition(" ")[0] in TEMPLATES]
    assert all("?" in row for row in rows)  # the question and the needs in one line
    assert len(outcome.out.strip().splitlines()) == len(rows) + 1 + 4 * 5 + 3 - 1  # titles and rules, how to copy
    groups = [line.partition(",")[0] for line in outcome.out.splitlines() if line.endswith("the simplest first")]
    assert groups == ["Reconstruction of crashes", "Engineering", "Projects and products"]
    assert "run-out" in outcome.out
    assert "--units si" in outcome.out


@pytest.mark.parametrize(("units", "expected"), [("imperial", "Speed, mph"), ("si", "Speed, km/h")])
def test_copies_the_edition_asked_for(xlmc, tmp_path, units, expected):
    assert xlmc("new", "skid", "case.xlsx", "--units", units).code == 0
    cells = openpyxl.load_workbook(tmp_path / "case.xlsx")["Scene"]["C"]
    assert expected in [cell.value for cell in cells]


@pytest.mark.parametrize("units", ["imperial", "si"])
def test_a_template_without_units_has_one_edition(xlmc, tmp_path, units):
    assert xlmc("new", "project", "plan.xlsx", "--units", units).code == 0
    assert (tmp_path / "plan.xlsx").read_bytes() == committed_books.TEMPLATES["project"].read_bytes()


def test_refuses_other_units(xlmc):
    outcome = xlmc("new", "skid", "--units", "cgs")
    assert outcome.code == 2
    assert "imperial" in outcome.err


def test_copies_a_template_that_runs(xlmc, tmp_path):
    outcome = xlmc("new", "planar-impact", "case.xlsx")
    assert outcome.code == 0
    assert "xlmc simulate case.xlsx" in outcome.out
    assert xlmc("check", tmp_path / "case.xlsx").code == 0


def test_names_the_copy_after_the_template(xlmc, tmp_path):
    assert xlmc("new", "planar-impact").code == 0
    assert (tmp_path / "planar-impact.xlsx").exists()


def test_never_overwrites(xlmc, tmp_path):
    mine = tmp_path / "case.xlsx"
    mine.write_text("my work", encoding="utf-8")
    outcome = xlmc("new", "planar-impact", mine)
    assert outcome.code == 2
    assert "exists already" in outcome.err
    assert mine.read_text(encoding="utf-8") == "my work"


def test_refuses_an_unknown_template(xlmc):
    outcome = xlmc("new", "plane-impact")
    assert outcome.code == 2
    assert "planar-impact" in outcome.err


def test_refuses_a_folder_that_is_not_there(xlmc, tmp_path):
    outcome = xlmc("new", "planar-impact", tmp_path / "nowhere" / "case.xlsx")
    assert outcome.code == 2
    assert "nowhere" in outcome.err


def test_results_and_marks_of_open_books_are_no_templates(tmp_path):
    folder = tmp_path / "templates"
    folder.mkdir()
    skid = committed_books.TEMPLATES["skid"]
    for name in ("skid", "skid-si", "skid-results", "skid-si-results", "skid-results-2", "skid-results-13"):
        shutil.copy(skid, folder / f"{name}.xlsx")
    (folder / "~$skid.xlsx").write_bytes(b"\x05Analyst")
    result = templates(tmp_path / "xlmc")
    assert {name: sorted(template.editions) for name, template in result.items()} == {"skid": ["imperial", "si"]}


def test_the_templates_are_the_committed_ones():
    files = [path for template in templates().values() for path in template.editions.values()]
    assert sorted(path.name for path in files) == sorted(path.name for path in committed_books.TEMPLATES.values())


PAGE = (committed_books.ROOT / "docs" / "other-fields.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("name", [name for name in TEMPLATES if DESCRIBED[name].group])
def test_the_page_of_other_fields_shows_what_is_printed(xlmc, name):
    (block,) = (
        part.partition("\n```")[0] for part in PAGE.split("```text\n") if part.startswith(f"$ xlmc new {name}\n")
    )
    assert xlmc("new", name).code == 0
    outcome = xlmc("simulate", f"{name}.xlsx")
    shown = "\n".join(line.rstrip() for line in outcome.out.splitlines())
    assert block.partition(f"$ xlmc simulate {name}.xlsx\n")[2] in shown
