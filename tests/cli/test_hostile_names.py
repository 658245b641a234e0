"""Names that steer a terminal or that XML cannot hold: every part that a run writes is well-formed and shows them."""

from __future__ import annotations

import json
import re
import zipfile
from xml.etree import ElementTree

import openpyxl
import pytest

RAW = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u2028\u2029\u202a-\u202e\u2066-\u2069\ufffe\uffff]")
# openpyxl writes `_x001B_` as it stands, which is how Excel writes the character.
MARKS = '_x001B_[2J_x0007_\x9b\u202e_xFFFF_<&">'


@pytest.fixture
def hostile(case_study, tmp_path):
    book = openpyxl.load_workbook(case_study)
    for sheet in book:
        for row in sheet.iter_rows():
            for cell in row:
                text = cell.value if isinstance(cell.value, str) else ""
                if " " in text and not text.startswith("=") and cell.row > 5:
                    cell.value += MARKS
    book.save(tmp_path / "case.xlsx")
    return tmp_path / "case.xlsx"


def test_every_part_is_well_formed_and_no_control_is_raw(xlmc, hostile, tmp_path):
    outputs = ("-o", "r.xlsx", "--html", "p.html", "--json", "j.json", "--extract", "t.csv", "--save-run", "s.xlmcrun")
    outcome = xlmc("simulate", hostile, "-n", 20_000, *outputs)
    assert outcome.code == 0, outcome.err
    assert "\\x1b[2J\\x07\\x9b\\u202e\\uffff" in outcome.out
    assert not RAW.search(outcome.out + outcome.err)
    with zipfile.ZipFile(tmp_path / "r.xlsx") as package:
        for name in package.namelist():
            if name.endswith((".xml", ".rels", ".vml")):
                ElementTree.fromstring(package.read(name))
    for name in ("p.html", "t.csv"):
        assert not RAW.search((tmp_path / name).read_text(encoding="utf-8-sig")), name
    assert not RAW.search(json.dumps(json.loads((tmp_path / "j.json").read_text())["forecasts"], ensure_ascii=False))
    assert xlmc("replay", "s.xlmcrun").code == 0
    assert xlmc("replay", "r.xlsx").code == 0
