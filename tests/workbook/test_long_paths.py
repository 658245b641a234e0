from __future__ import annotations

import ntpath
from pathlib import Path, PureWindowsPath

import pytest

from xlmc.workbook.writer import extended, openable

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
