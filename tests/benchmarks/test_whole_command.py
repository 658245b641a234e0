from __future__ import annotations

import io
import re
import zipfile

import whole_command
from fewer_sheets import SENSITIVITY, leave_out

from xlmc.excel.workbook.writer import package_bytes
from xlmc.outputs.sheets import book

TRIALS = 3_000
NUMBER = re.compile(rb"<v>([^<]*\.[^<]*)</v>")


def _as_xlsxwriter_writes(part):
    """Numbers with 13 digits, and lines of charts that are not said to be straight."""
    thirteen = NUMBER.sub(lambda result: b"<v>%.13G</v>" % float(result[1]), part)
    return thirteen.replace(b'<c:smooth val="0"/>', b"")


def test_the_baseline_writes_the_same_sheets(tmp_path, monkeypatch):
    """Part by part, byte by byte, but for what xlmc adds to XlsxWriter; without the sheets that take longest."""
    leave_out(monkeypatch, *SENSITIVITY)
    recording, target = tmp_path / "calls", tmp_path / "baseline.xlsx"
    built, real = [], book.build_sheets
    monkeypatch.setattr(book, "build_sheets", lambda run, command: built.append(real(run, command=command)))
    assert whole_command.record(recording, TRIALS) > 1_000
    assert whole_command.baseline(recording, target) > 0
    with zipfile.ZipFile(io.BytesIO(package_bytes(built[0]))) as ours, zipfile.ZipFile(target) as theirs:
        assert sum(name.startswith("xl/worksheets/sheet") for name in ours.namelist()) == 10
        assert sorted(theirs.namelist()) == sorted(ours.namelist())
        for name in ours.namelist():
            assert _as_xlsxwriter_writes(theirs.read(name)) == _as_xlsxwriter_writes(ours.read(name)), name
