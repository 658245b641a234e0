"""The case in docs/evidence.md can be followed: its table, typed into the book, gives the numbers that it quotes."""

from __future__ import annotations

import re
from pathlib import Path

import openpyxl
import pytest
from openpyxl.worksheet.table import Table

import xlmc

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "evidence.md").read_text(encoding="utf-8")
CASE = PAGE[PAGE.index("## A case: an EDR and a camera") : PAGE.index("## Off and on")]
PROSE = " ".join(CASE.split())


def rows_of(first):
    """The table whose first heading this is."""
    found = re.search(rf"^\| {re.escape(first)} \|.*\n\|[-|]+\n((?:\|.*\n)+)", CASE, re.MULTILINE)
    head = CASE[found.start() : found.end()].splitlines()[0]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in (head, *found[1].splitlines())]


def number(text):
    try:
        return float(text)
    except ValueError:
        return text or None


@pytest.fixture(scope="module")
def book(tmp_path_factory):
    def make(speed=34.1):
        made = openpyxl.load_workbook(ROOT / "examples" / "intersection.xlsx")
        sheet = made.create_sheet("Facts")
        rows = [[number(cell) for cell in row] for row in rows_of("Name")]
        rows[2][2] = speed
        for row in rows:
            sheet.append(row)
        sheet.add_table(Table(displayName="xlmc_evidence", ref=f"A1:H{len(rows)}"))
        made.save(path := tmp_path_factory.mktemp("case") / "my-case.xlsx")
        return xlmc.load(path)

    return make


def test_the_case_gives_what_the_page_says(book):
    model = book()
    assert all(f"{end:.6g}" in PROSE for end in (model.filters[3].at_least, model.filters[3].at_most))
    run = model.simulate()
    found = run.agreement
    assert f"together they keep {found.ratio.value:.3g} times" in PROSE
    assert found.sentence.partition(":")[0] in PROSE
    first, second = (round(100 * each.chance) for each in found.items)
    assert f"has a chance of {first} %, one as the camera's {second} %" in PROSE
    heads, *lines = rows_of("means, mph, with")
    means = {(each.used, each.forecast): each for each in found.answers}
    for used, *shown in lines:
        assert shown == [f"{means[used, name].mean.value:.3f}" for name in heads[1:]]
    before, after = (means[used, "Chevrolet impact speed"] for used in ("no evidence", "all evidence"))
    spreads = f"from {before.standard_deviation.value:.2f} to {after.standard_deviation.value:.2f} mph"
    assert spreads in PROSE
    assert f"{after.mean.value:.2f} mph, with a standard deviation of {after.standard_deviation.value:.2f} mph" in PROSE
    assert run.warnings == []


def test_the_contradicting_video_is_out_of_reach(book):
    run = book(39.5).simulate()
    assert run.settings.evidence == "weights"
    assert "the evidence is inconsistent" in run.warnings[0]
    assert f"the effective sample size, {run.weighting.effective:.0f}, says" in PROSE
    assert 1.5 < run.weighting.mean * run.accepted < 2.5
