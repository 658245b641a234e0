from __future__ import annotations

import errno
import io
import ntpath
import os
import stat
import zipfile
from pathlib import Path, PureWindowsPath

import pytest

from xlmc.errors import WorkbookError
from xlmc.excel.workbook import writer
from xlmc.excel.workbook.package import read_parts
from xlmc.excel.workbook.writer import check_folder, extended, openable, package_bytes, refuse_if_open, write_workbook

PARTS = {
    "xl/workbook.xml": b"<w/>",
    "_rels/.rels": b"<r/>",
    "[Content_Types].xml": b"<t/>",
    "docs/Ünï.xml": b"\xe9",
}


def test_a_package_reads_back_content_types_first():
    packed = package_bytes(PARTS)
    assert read_parts(packed) == PARTS
    assert list(read_parts(packed)) == ["[Content_Types].xml", "_rels/.rels", "xl/workbook.xml", "docs/Ünï.xml"]


def test_a_package_knows_neither_time_nor_machine():
    with zipfile.ZipFile(io.BytesIO(package_bytes(PARTS))) as package:
        for entry in package.infolist():
            assert entry.date_time == (1980, 1, 1, 0, 0, 0)
            assert (entry.create_system, entry.external_attr, entry.extra) == (0, 0o600 << 16, b"")
            assert entry.compress_type == zipfile.ZIP_DEFLATED


def test_the_same_parts_give_the_same_bytes():
    assert package_bytes(PARTS) == package_bytes(dict(PARTS))


def test_a_new_file_is_written_and_nothing_else(tmp_path):
    write_workbook(tmp_path / "book.xlsx", b"data")
    assert [(path.name, path.read_bytes()) for path in tmp_path.iterdir()] == [("book.xlsx", b"data")]


def test_an_existing_file_is_replaced_and_keeps_its_permissions(tmp_path):
    path = tmp_path / "book.xlsx"
    path.write_bytes(b"old")
    path.chmod(0o640)
    write_workbook(str(path), b"new")
    assert path.read_bytes() == b"new"
    assert stat.S_IMODE(path.stat().st_mode) == 0o640


def test_a_link_keeps_pointing_at_its_file(tmp_path):
    (tmp_path / "real.xlsx").write_bytes(b"old")
    link = tmp_path / "link.xlsx"
    link.symlink_to("real.xlsx")
    write_workbook(link, b"new")
    assert link.is_symlink()
    assert (tmp_path / "real.xlsx").read_bytes() == b"new"


def test_the_system_says_which_folder_two_dots_mean(tmp_path):
    (tmp_path / "here").mkdir()
    (tmp_path / "there" / "inner").mkdir(parents=True)
    (tmp_path / "here" / "link").symlink_to(tmp_path / "there" / "inner")
    (tmp_path / "here" / "book.xlsx").write_bytes(b"old")
    behind_link = tmp_path / "here" / "link" / ".." / "book.xlsx"
    write_workbook(behind_link, b"new")
    assert behind_link.read_bytes() == b"new"
    assert (tmp_path / "here" / "book.xlsx").read_bytes() == b"old"


@pytest.mark.skipif(os.name == "nt", reason="Windows takes `missing\\..` out of a path before it looks")
@pytest.mark.parametrize("write", [check_folder, lambda path: write_workbook(path, b"new")])
def test_a_folder_that_does_not_exist_has_no_folder_above_it(tmp_path, write):
    (tmp_path / "book.xlsx").write_bytes(b"old")
    with pytest.raises(WorkbookError, match="There is no folder"):
        write(tmp_path / "missing" / ".." / "book.xlsx")
    assert (tmp_path / "book.xlsx").read_bytes() == b"old"


@pytest.mark.parametrize(
    ("code", "message"),
    [
        (errno.ENOSPC, "The disk is full"),
        (errno.EDQUOT, "The disk is full"),
        (errno.EACCES, "in use or may not be written"),
        (errno.EPERM, "in use or may not be written"),
        (errno.EROFS, "in use or may not be written"),
        (errno.EIO, "cannot be written"),
    ],
)
@pytest.mark.parametrize("step", ["_write_synced", "os.replace"])
def test_a_failed_write_leaves_the_old_file_and_no_other(tmp_path, monkeypatch, step, code, message):
    path = tmp_path / "book.xlsx"
    path.write_bytes(b"old")

    def fail(*_):
        raise OSError(code, os.strerror(code))

    monkeypatch.setattr(f"{writer.__name__}.{step}", fail)
    with pytest.raises(WorkbookError, match=message) as caught:
        write_workbook(path, b"new")
    assert caught.value.where == str(path)
    assert [(left.name, left.read_bytes()) for left in tmp_path.iterdir()] == [("book.xlsx", b"old")]


def test_an_interrupted_write_leaves_the_old_file_and_no_other(tmp_path, monkeypatch):
    path = tmp_path / "book.xlsx"
    path.write_bytes(b"old")

    def interrupt(_):
        raise KeyboardInterrupt

    monkeypatch.setattr(os, "fsync", interrupt)
    with pytest.raises(KeyboardInterrupt):
        write_workbook(path, b"new")
    assert [(left.name, left.read_bytes()) for left in tmp_path.iterdir()] == [("book.xlsx", b"old")]


def test_a_missing_folder_is_named(tmp_path):
    with pytest.raises(WorkbookError, match="There is no folder") as caught:
        write_workbook(tmp_path / "nowhere" / "book.xlsx", b"")
    assert str(tmp_path / "nowhere") in caught.value.message


def test_a_file_in_place_of_the_folder_is_no_folder(tmp_path):
    (tmp_path / "file").write_bytes(b"")
    with pytest.raises(WorkbookError, match="There is no folder"):
        write_workbook(tmp_path / "file" / "book.xlsx", b"")


def test_a_folder_is_not_overwritten(tmp_path):
    (tmp_path / "book.xlsx").mkdir()
    with pytest.raises(WorkbookError, match="This is a folder"):
        write_workbook(tmp_path / "book.xlsx", b"")
    assert [path.name for path in tmp_path.iterdir()] == ["book.xlsx"]


def test_a_read_only_file_is_respected(tmp_path, monkeypatch):
    path = tmp_path / "book.xlsx"
    path.write_bytes(b"old")
    monkeypatch.setattr(os, "access", lambda *_: False)  # an administrator may write anything, and tests may run as one
    with pytest.raises(WorkbookError, match="may not be written"):
        write_workbook(path, b"new")
    assert path.read_bytes() == b"old"


@pytest.mark.parametrize("name", ["new.xlsx", "old.xlsx"])
def test_what_may_not_be_written_is_known_before_any_work(tmp_path, monkeypatch, name):
    (tmp_path / "old.xlsx").write_bytes(b"old")
    check_folder(tmp_path / name)
    monkeypatch.setattr(os, "access", lambda *_: False)
    with pytest.raises(WorkbookError, match="may not be written"):
        check_folder(tmp_path / name)


@pytest.mark.parametrize(("owner", "program"), [("~$book.xlsx", "Excel"), (".~lock.book.xlsx#", "LibreOffice")])
def test_an_open_workbook_is_refused(tmp_path, owner, program):
    path = tmp_path / "book.xlsx"
    refuse_if_open(path)
    (tmp_path / owner).write_bytes(b"\x05A. Person")
    with pytest.raises(WorkbookError, match=f"{program} holds the workbook open") as caught:
        refuse_if_open(path)
    assert owner in caught.value.hint


def test_another_workbook_may_be_open(tmp_path):
    (tmp_path / "~$other.xlsx").write_bytes(b"")
    refuse_if_open(tmp_path / "book.xlsx")


def held(code, times, then):
    """A call that fails as on Windows, so many times."""
    left = [times]

    def rename(source, target):
        if left[0]:
            left[0] -= 1
            error = PermissionError(errno.EACCES, "The process cannot access the file")
            error.winerror = code
            raise error
        return then(source, target)

    return rename


@pytest.mark.parametrize("code", [5, 32, 33, 1224, 362, 391, 404, 426])
def test_a_file_that_is_held_for_a_moment_is_replaced(tmp_path, monkeypatch, code):
    path = tmp_path / "book.xlsx"
    path.write_bytes(b"old")
    naps = []
    monkeypatch.setattr("time.sleep", naps.append)
    monkeypatch.setattr(os, "replace", held(code, 3, os.replace))
    write_workbook(path, b"new")
    assert path.read_bytes() == b"new"
    assert naps == [0.05, 0.1, 0.2]


def test_a_file_that_is_held_for_long_stays_and_is_told_of(tmp_path, monkeypatch):
    path = tmp_path / "book.xlsx"
    path.write_bytes(b"old")
    monkeypatch.setattr("time.sleep", lambda _: None)
    monkeypatch.setattr(os, "replace", held(32, 100, os.replace))
    with pytest.raises(writer.TakenError, match=r"Another program holds the file\. Close it in Excel") as caught:
        write_workbook(path, b"new")
    assert caught.value.where == str(path)
    assert [(left.name, left.read_bytes()) for left in tmp_path.iterdir()] == [("book.xlsx", b"old")]


def test_a_new_name_is_tried_again_too_and_never_replaces(tmp_path, monkeypatch):
    """What `os.rename` does on Windows."""
    monkeypatch.setattr("time.sleep", lambda _: None)
    (tmp_path / "temporary").write_bytes(b"new")
    writer._patiently(held(33, 2, os.rename), tmp_path / "temporary", tmp_path / "book.xlsx")
    assert (tmp_path / "book.xlsx").read_bytes() == b"new"

    def taken(*_):
        raise FileExistsError(errno.EEXIST, "Cannot create a file when that file already exists")

    with pytest.raises(FileExistsError):
        writer._patiently(taken, tmp_path / "temporary", tmp_path / "book.xlsx")


def test_a_disk_without_second_names_is_written_to(tmp_path, monkeypatch):
    def refuse(*_):
        raise PermissionError(errno.EPERM, "Operation not permitted")

    monkeypatch.setattr(os, "link", refuse)
    write_workbook(tmp_path / "book.xlsx", b"new")
    assert [(left.name, left.read_bytes()) for left in tmp_path.iterdir()] == [("book.xlsx", b"new")]


LONG = "\\".join(["folder of a case"] * 16)


@pytest.mark.parametrize(
    ("path", "expected"),
    [
        (r"C:\cases\case.xlsx", r"C:\cases\case.xlsx"),
        (r"\\server\share\case.xlsx", r"\\server\share\case.xlsx"),
        (rf"C:\{LONG}\case.xlsx", rf"\\?\C:\{LONG}\case.xlsx"),
        (rf"\\server\share\{LONG}\case.xlsx", rf"\\?\UNC\server\share\{LONG}\case.xlsx"),
        (rf"C:/{LONG}/../case.xlsx".replace("\\", "/"), "\\\\?\\" + ntpath.normpath(rf"C:\{LONG}\..\case.xlsx")),
        (rf"\\?\C:\{LONG}\case.xlsx", rf"\\?\C:\{LONG}\case.xlsx"),
        (rf"{LONG}\case.xlsx", rf"{LONG}\case.xlsx"),  # relative: nothing to extend
    ],
)
def test_long_windows_paths_are_extended(path, expected):
    assert extended(path) == expected


def test_a_folder_so_long_that_the_temporary_file_would_not_fit_is_extended_too():
    folder = "C:\\" + "x" * 215
    assert extended(rf"{folder}\a.xlsx").startswith("\\\\?\\C:\\")


@pytest.mark.parametrize("path", [rf"\\server\share\{LONG}\case.xlsx", r"\\server\share\case.xlsx"])
def test_names_beside_a_path_on_a_server_stay_on_it(path):
    beside = PureWindowsPath(extended(path)).with_name("case-2.xlsx")
    assert str(beside) == extended(path).replace("case.xlsx", "case-2.xlsx")
    assert beside.parent == PureWindowsPath(extended(path)).parent


def test_elsewhere_paths_are_as_they_are():
    assert openable(Path("/tmp") / ("x" * 300)) == "/tmp/" + "x" * 300
