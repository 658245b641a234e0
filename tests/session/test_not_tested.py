from __future__ import annotations

from needed_programs import missing


def test_a_program_that_is_there_is_not_missing(tmp_path, monkeypatch):
    (tmp_path / "soffice").write_text("#!/bin/sh\n", encoding="utf-8")
    (tmp_path / "soffice").chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path))
    assert missing("soffice") == ""
    assert missing("soffice", "pdftotext", "pdftoppm") == "poppler is not installed (apt-get install poppler-utils)"
