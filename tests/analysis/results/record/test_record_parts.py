from __future__ import annotations

import json

import pytest

from xlmc.analysis.results.record import Entry, Record, RecordTable, Section

RECORD = Record(
    (
        Section("file", "Workbook", (Entry("name", "Name", "a.xlsx"), Entry("size", "Size", 3))),
        Section("rows", "Rows", table=RecordTable((("k", "K"), ("v", "V")), ((1, None), (2, 0.5)))),
    )
)


def test_entries_and_rows_are_found_by_key():
    assert RECORD["file.name"] == "a.xlsx"
    assert RECORD.rows("rows") == [{"k": 1, "v": None}, {"k": 2, "v": 0.5}]
    assert RECORD.rows("file") == []


@pytest.mark.parametrize("key", ["file.none", "none.name", "file", ""])
def test_unknown_keys_are_refused(key):
    with pytest.raises(KeyError):
        RECORD[key]


def test_a_record_goes_through_json_unchanged():
    result = RECORD.as_dict()
    assert result == {
        "file": {"name": "a.xlsx", "size": 3},
        "rows": {"rows": [{"k": 1, "v": None}, {"k": 2, "v": 0.5}]},
    }
    assert json.loads(json.dumps(result, allow_nan=False)) == result
