"""What is no workbook is named for what it is, each with its own cure."""

from __future__ import annotations

import io
import zipfile

import pytest

from xlmc.errors import WorkbookError
from xlmc.excel.workbook.reader import read_workbook

OLE = bytes.fromhex("D0CF11E0A1B11AE1") + bytes(600)


def packed(**entries):
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w") as package:
        for name, text in entries.items():
            package.writestr(name, text)
    return file.getvalue()


@pytest.mark.parametrize(
    ("data", "sentence", "cure"),
    [
        (OLE, "old Excel workbook (.xls)", "save it as an Excel Workbook"),
        (OLE + "EncryptedPackage".encode("utf-16-le"), "encrypted", "Remove its password"),
        (packed(mimetype="application/vnd.oasis.opendocument.spreadsheet"), "(.ods)", "LibreOffice"),
        (b"a;b\r\n1;2\r\n", "plain text", "save it as"),
        (b"\xef\xbb\xbf<!DOCTYPE html><html>", "web page", "save it as"),
        (b'<?xml version="1.0"?><Workbook/>', "XML file", "save it as"),
        (b"", "empty", "Fetch or copy it again"),
        (packed(a="b" * 999)[:-40], "damaged", "Fetch or copy it again"),
        (bytes(300), "not an Excel workbook", "save it as"),
    ],
)
def test_what_is_no_workbook_is_named_with_its_cure(data, sentence, cure):
    with pytest.raises(WorkbookError) as expected:
        read_workbook(data, "case.xlsx")
    assert sentence in expected.value.message
    assert cure in (expected.value.hint or "")
