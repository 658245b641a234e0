from __future__ import annotations

import io

import openpyxl
import pytest
import whole_command
from packed_sheets import packed_sheets

import xlmc

TRIALS = 3_000


def test_the_baseline_writes_the_same_sheets(tmp_path):
    recording, target = tmp_path / "calls", tmp_path / "baseline.xlsx"
    assert whole_command.record(recording, TRIALS) > 1_000
    assert whole_command.baseline(recording, target) > 0
    run = xlmc.load(whole_command.CASE_STUDY).simulate(TRIALS)
    ours = openpyxl.load_workbook(io.BytesIO(packed_sheets(run, command="")))
    theirs = openpyxl.load_workbook(target)
    assert theirs.sheetnames == ours.sheetnames
    for name in ours.sheetnames:
        assert len(theirs[name]._charts) == len(ours[name]._charts)
        pairs = zip(theirs[name].iter_rows(), ours[name].iter_rows(), strict=True)
        for mine, yours in ((a, b) for rows in pairs for a, b in zip(*rows, strict=True)):
            assert mine.number_format == yours.number_format
            if isinstance(yours.value, float):
                assert mine.value == pytest.approx(yours.value, rel=1e-15)  # XlsxWriter writes 16 digits
            else:
                assert mine.value == yours.value
