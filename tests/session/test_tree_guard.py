from __future__ import annotations

import os

from tree_guard import changes, snapshot


def test_what_appeared_changed_or_went_is_named(tmp_path):
    for name in ("kept", "longer", "later", "gone"):
        (tmp_path / name).write_text("old", encoding="utf-8")
    before = snapshot(tmp_path)
    (tmp_path / "longer").write_text("older", encoding="utf-8")
    os.utime(tmp_path / "later", ns=(1, 1))
    (tmp_path / "gone").unlink()
    (tmp_path / "examples").mkdir()
    (tmp_path / "examples" / "a-results.xlsx").write_text("new", encoding="utf-8")
    assert changes(before, snapshot(tmp_path)) == [
        f"appeared: {os.path.join('examples', 'a-results.xlsx')}",
        "is gone: gone",
        "changed: later",
        "changed: longer",
    ]


def test_caches_and_environments_are_not_looked_into(tmp_path):
    for folder in (".git", ".hypothesis", "x/__pycache__", "xlmc.egg-info", ".venv/lib", "other/lib"):
        (tmp_path / folder).mkdir(parents=True)
        (tmp_path / folder / "file").write_text("", encoding="utf-8")
    for environment in (".venv", "other"):
        (tmp_path / environment / "pyvenv.cfg").write_text("", encoding="utf-8")
    assert snapshot(tmp_path) == {}
