from __future__ import annotations

import shutil

from committed_books import TEMPLATES

from xlmc.cli import templates_folder


def test_results_and_marks_of_open_books_are_no_templates(tmp_path, monkeypatch):
    folder = tmp_path / "templates"
    folder.mkdir()
    for name in ("skid", "skid-si", "skid-results", "skid-si-results", "skid-results-2", "skid-results-13"):
        shutil.copy(TEMPLATES["skid"], folder / f"{name}.xlsx")
    (folder / "~$skid.xlsx").write_bytes(b"\x05Analyst")
    monkeypatch.setattr(templates_folder, "__file__", str(tmp_path / "xlmc" / "cli" / "templates_folder.py"))
    found = templates_folder.templates()
    assert {name: sorted(template.editions) for name, template in found.items()} == {"skid": ["imperial", "si"]}


def test_the_templates_are_the_committed_ones():
    files = [path for template in templates_folder.templates().values() for path in template.editions.values()]
    assert sorted(path.name for path in files) == sorted(path.name for path in TEMPLATES.values())
