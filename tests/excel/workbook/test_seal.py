from __future__ import annotations

import io

import pytest

from xlmc.excel.workbook.package import read_parts
from xlmc.excel.workbook.seal import blank_seal, read_seal, seal_file, sealed_parts, sealed_text
from xlmc.excel.workbook.target import Target
from xlmc.excel.workbook.writer import TakenError, package_bytes

SHEET = "xl/worksheets/sheet1.xml"
NAMESPACE = b"http://schemas.openxmlformats.org/package/2006/content-types"
TYPES = b'<Types xmlns="%b"><Default Extension="rels" ContentType="r"/></Types>' % NAMESPACE
PARTS = {"[Content_Types].xml": TYPES, "xl/workbook.xml": b"<w/>", SHEET: b"<s/>", "docs/Ünï.xml": b"\xe9"}
NAMES = ["case.xlsx", "Ünfall -- 1 > 0.xlsx", 'a"b&c.xlsx', "\udc80.xlsx", "x" * 255]


def written(path, parts):
    path.write_bytes(package_bytes(parts))
    return path


@pytest.mark.parametrize("name", NAMES)
def test_a_package_is_known_again(tmp_path, name):
    seal = read_seal(written(tmp_path / "out.xlsx", sealed_parts(PARTS, SHEET, name)))
    assert (seal.book, seal.whole) == (name, True)


@pytest.mark.parametrize("ending", [".xlsx", ".xlsm", ".xltx", ".xltm", ".XLTM"])
def test_a_workbook_of_any_kind_is_known_again(tmp_path, ending):
    path = written(tmp_path / f"out{ending}", sealed_parts(PARTS, SHEET, "case.xlsx"))
    assert read_seal(path).whole
    Target(path, "case.xlsx").check()
    path.with_name(f"~$out{ending}").touch()
    with pytest.raises(TakenError, match="Excel holds the workbook open"):
        Target(path, "case.xlsx").check()


def test_a_package_packed_anew_is_still_whole(tmp_path):
    parts = sealed_parts(PARTS, SHEET, "case.xlsx")
    assert read_seal(written(tmp_path / "out.xlsx", dict(reversed(parts.items())))).whole


@pytest.mark.parametrize("name", [*PARTS, "xl/worksheets/_rels/sheet1.xml.rels"])
def test_a_package_with_any_part_changed_is_not_whole(tmp_path, name):
    parts = sealed_parts(PARTS, SHEET, "case.xlsx")
    parts[name] += b" "
    assert not read_seal(written(tmp_path / "out.xlsx", parts)).whole


def test_a_package_with_a_part_more_or_less_is_not_whole(tmp_path):
    parts = sealed_parts(PARTS, SHEET, "case.xlsx")
    assert not read_seal(written(tmp_path / "more.xlsx", parts | {"new.xml": b""})).whole
    assert not read_seal(
        written(tmp_path / "less.xlsx", {n: c for n, c in parts.items() if n != "xl/workbook.xml"})
    ).whole


@pytest.mark.parametrize("content", [b"", b"text", b"PK\x03\x04 damaged", package_bytes(PARTS)])
def test_other_files_have_no_seal(tmp_path, content):
    (tmp_path / "out.xlsx").write_bytes(content)
    assert read_seal(tmp_path / "out.xlsx") is None


@pytest.mark.parametrize("seal", [b"", b"[]", b"{}", b'{"book": "b"}', b'{"book": 1, "sha256": 2}', b"[" * 100_000])
def test_a_seal_that_somebody_wrote_is_none(tmp_path, seal):
    result = read_seal(written(tmp_path / "out.xlsx", PARTS | {"xl/xlmc/seal1.json": seal}))
    assert result is None or not result.whole


def test_a_seal_of_the_users_own_stays(tmp_path):
    mine = PARTS | {"xl/xlmc/seal1.json": b"mine"}
    parts = sealed_parts(mine, SHEET, "case.xlsx")
    assert parts["xl/xlmc/seal1.json"] == b"mine"
    assert b"/xl/xlmc/seal2.json" in parts["[Content_Types].xml"] or b'Extension="json"' in parts["[Content_Types].xml"]


def test_of_a_package_with_two_seals_nobody_is_known(tmp_path):
    parts = sealed_parts(PARTS, SHEET, "case.xlsx")
    parts["xl/xlmc/seal2.json"] = parts["xl/xlmc/seal1.json"]
    assert read_seal(written(tmp_path / "out.xlsx", parts)) is None


TEXTS = {".html": b"<html></html>\n", ".json": b'{\n  "a": 1', ".htm": b"<p>"}


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("ending", TEXTS)
def test_a_text_is_known_again_until_a_byte_changes(tmp_path, ending, name):
    path = tmp_path / f"out{ending}"
    whole = sealed_text(TEXTS[ending], ending, name)
    path.write_bytes(whole)
    assert (read_seal(path).book, read_seal(path).whole) == (name, True)
    for changed in (b" " + whole, whole.replace(b"book=", b"book=y"), whole[1:]):
        path.write_bytes(changed)
        assert not read_seal(path).whole
    for lost in (whole + b" ", whole[:-1], whole.replace(b"sha256=", b"sha256= ")):
        path.write_bytes(lost)
        assert read_seal(path) is None


def test_a_long_file_is_read_whole(tmp_path):
    path = tmp_path / "out.html"
    whole = sealed_text(b"x" * 3_000_001, ".html", "case.xlsx")
    path.write_bytes(whole)
    assert read_seal(path).whole
    path.write_bytes(b"y" + whole[1:])
    assert not read_seal(path).whole


@pytest.mark.parametrize("name", NAMES)
def test_a_zip_comment_is_a_seal(tmp_path, name):
    file = io.BytesIO(b"PK" + b"x" * 10 + blank_seal(name))
    seal_file(file, name)
    (tmp_path / "run.xlmcrun").write_bytes(file.getvalue())
    assert (read_seal(tmp_path / "run.xlmcrun").book, read_seal(tmp_path / "run.xlmcrun").whole) == (name, True)


def test_the_seal_goes_with_the_sheet_that_points_to_it():
    pointers = sealed_parts(PARTS, SHEET, "case.xlsx")["xl/worksheets/_rels/sheet1.xml.rels"]
    assert b'Type="urn:xlmc:seal"' in pointers
    assert b'Target="../xlmc/seal1.json"' in pointers
    assert read_parts(package_bytes(PARTS)) == PARTS
