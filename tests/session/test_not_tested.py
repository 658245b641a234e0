from __future__ import annotations

import pytest
from needed_programs import missing

TESTS = """
import pytest
from needed_programs import missing

@pytest.fixture(scope="session")
def browser(): pytest.skip(missing("chromium", "chromedriver"))

def test_in_a_browser(browser): pass
def test_also(browser): pass

@pytest.mark.skipif(bool(missing("soffice")), reason=missing("soffice"))
def test_printed(): pass
def test_plain(): pass
"""
BROWSER = "Chromium and Chromium's driver are not installed (apt-get install chromium; apt-get install chromium-driver)"


@pytest.mark.parametrize("processes", [[], ["-n", "1"]])
def test_the_summary_names_what_was_skipped_and_why(run_tests, processes):
    code, shown = run_tests(TESTS, *processes, plugin="not_tested", PATH="")
    assert code == 0
    told = shown.partition("Not tested here")[2]
    assert f"test_given.py (2): {BROWSER}" in told
    assert "test_given.py (1): LibreOffice is not installed (apt-get install libreoffice-calc-nogui)" in told
    assert "1 passed, 3 skipped" in told


def test_nothing_is_said_where_nothing_is_skipped(run_tests):
    code, shown = run_tests("def test(): pass", plugin="not_tested")
    assert code == 0
    assert "Not tested here" not in shown


def test_a_program_that_is_there_is_not_missing(tmp_path, monkeypatch):
    (tmp_path / "soffice").write_text("#!/bin/sh\n", encoding="utf-8")
    (tmp_path / "soffice").chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path))
    assert missing("soffice") == ""
    assert missing("soffice", "pdftotext", "pdftoppm") == "poppler is not installed (apt-get install poppler-utils)"
