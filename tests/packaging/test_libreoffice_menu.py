from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
import time
from contextlib import suppress
from pathlib import Path

import openpyxl
import pytest
from needed_programs import missing

ROOT = Path(__file__).parents[2]
EXTENSION = ROOT / "packaging" / "libreoffice"
PYTHON = "/usr/bin/python3"  # the one that UNO is made for
needs = missing("soffice")
if not needs and subprocess.run([PYTHON, "-c", "import uno"], capture_output=True).returncode:
    needs = "UNO is not installed (apt-get install python3-uno)"
pytestmark = pytest.mark.skipif(bool(needs), reason=needs)


@pytest.fixture(scope="module")
def office(tmp_path_factory):
    """A LibreOffice with the extension in a profile of its own; a function that chooses an entry of the menu there."""
    folder = tmp_path_factory.mktemp("office")
    profile = f"-env:UserInstallation={(folder / 'profile').as_uri()}"
    package = folder / "xlmc.oxt"
    subprocess.run([sys.executable, EXTENSION / "build.py", package], check=True)
    programs = folder / "programs"
    programs.mkdir()
    command = programs / "xlmc"
    started = folder / "started"
    command.write_text(f'#!/bin/sh\necho $$ >> "{started}"\nexec "{sys.executable}" -m xlmc "$@"\n', encoding="utf-8")
    command.chmod(0o755)
    browser = programs / "browser"
    browser.write_text(f'#!/bin/sh\necho "$1" > "{folder}/browsed"\n', encoding="utf-8")
    browser.chmod(0o755)
    # LibreOffice's Python takes its library from the first python3 on the path, so that another one must not be there.
    paths = {"PATH": f"{programs}:/usr/bin:/bin", "BROWSER": f"{browser} %s"}
    environment = os.environ | paths | {"XDG_STATE_HOME": str(folder / "state"), "HOME": str(folder)}
    pipe = f"xlmc-{os.getpid()}"
    server = subprocess.Popen(
        ["soffice", profile, "--headless", "--norestore", f"--accept=pipe,name={pipe};urp"],
        env=environment,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    )

    def choose(entry: str, book: Path | str, *options: str, path: str = "") -> dict[str, object]:
        place = {"PATH": path} if path else {}
        program = [PYTHON, ROOT / "tests/packaging/libreoffice_session.py"]
        done = subprocess.run(
            [*program, pipe, EXTENSION / "xlmc_menu.py", entry, book, *options],
            env=environment | place,
            capture_output=True,
            timeout=120,
            encoding="utf-8",
            check=True,
        )
        return json.loads(done.stdout)

    choose.folder = folder
    try:
        choose("install", package)
        yield choose
    finally:
        os.killpg(server.pid, signal.SIGKILL)
        server.wait()
        for number in map(int, started.read_text(encoding="utf-8").split() if started.exists() else ()):
            with suppress(ProcessLookupError):  # the live window alone goes on
                os.kill(number, signal.SIGINT)


@pytest.fixture
def book(tmp_path):
    return Path(shutil.copy(ROOT / "examples" / "intersection.xlsx", tmp_path / "my case.xlsx"))


def test_simulate_opens_the_workbook_with_the_results(office, book):
    result = office("simulate", book, "--installed")
    assert result["opened"] == {"my case.xlsx": "Inputs", "my case-results.xlsx": "Results"}
    assert "Results" in openpyxl.load_workbook(book.with_name("my case-results.xlsx"), read_only=True).sheetnames


def test_check_says_what_xlmc_says_last(office, book):
    assert office("check", book)["shown"][0].endswith("No problem found.")


def test_check_selects_the_cell_of_the_problem(office, book):
    edited = openpyxl.load_workbook(book)
    edited["Inputs"]["F9"] = "Unifrom"
    edited.save(book)
    result = office("check", book)
    assert "Unifrom" in result["shown"][0]
    assert result["selected"] == "$Inputs.$F$9"


@pytest.mark.parametrize(("answer", "saved"), [("--ok", True), ("--cancel", False)])
def test_a_changed_workbook_is_saved_if_the_user_wants(office, book, answer, saved):
    result = office("check", book, "--modified", answer)
    assert "Save my case.xlsx now?" in result["shown"][0]
    assert result["modified"] is not saved
    assert ("No problem found." in result["shown"][-1]) is saved


def test_without_a_workbook(office):
    assert office("simulate", "-")["shown"] == ["No workbook is open: open one, and choose the entry again."]


def test_without_the_program(office, book):
    assert "xlmc was not found" in office("check", book, path="/usr/bin:/bin")["shown"][0]


def test_the_window_opens_in_the_browser(office, book):
    result = office("open", book)
    assert result["shown"] == []
    browsed, end = office.folder / "browsed", time.monotonic() + 60
    while not browsed.exists() and time.monotonic() < end:
        time.sleep(0.1)
    assert browsed.read_text(encoding="utf-8").startswith("file:")


def test_the_menu_is_in_the_menu_bar_of_calc():
    text = (EXTENSION / "Addons.xcu").read_text(encoding="utf-8")
    assert text.count("service:xlmc.Menu?") == 3
