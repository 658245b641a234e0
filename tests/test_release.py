"""The changelog, the version and the workflows are in the state from which a release can be made."""

from __future__ import annotations

import importlib.util
import re
from pathlib import Path
from statistics import median

import pytest

ROOT = Path(__file__).resolve().parents[1]


@pytest.fixture(scope="module")
def release():
    spec = importlib.util.spec_from_file_location("release", ROOT / ".ci" / "release.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_entries_of_the_changelog_are_short():
    entries = re.findall(r"^- .*(?:\n  .*)*", (ROOT / "CHANGELOG.md").read_text("utf-8"), re.MULTILINE)
    assert median(len(entry.split()) - 1 for entry in entries) < 15


def test_every_version_before_this_one_has_a_date():
    headings = re.findall(r"^## (.*)$", (ROOT / "CHANGELOG.md").read_text("utf-8"), re.MULTILINE)
    assert all(re.fullmatch(r"\d+\.\d+\.\d+ - \d{4}-\d\d-\d\d", heading) for heading in headings[1:])


def test_what_is_not_ready_is_named(release, tmp_path, monkeypatch):
    (tmp_path / "changes").mkdir()
    (tmp_path / "changes" / "51.added.md").write_text("More", encoding="utf-8")
    address = '[project.urls]\nRepository = "https://HOST.invalid/OWNER/xlmc"\n'
    (tmp_path / "pyproject.toml").write_text(f'[project]\nversion = "2.0.0"\n{address}', encoding="utf-8")
    long = " ".join(["word"] * 20)
    (tmp_path / "CHANGELOG.md").write_text(f"## 1.0.0\n\n- {long}\n", encoding="utf-8")
    monkeypatch.setattr(release, "ROOT", tmp_path)
    message = "\n".join(release.faults())
    for part in ("does not begin with 2.0.0", "1.0.0 no date", "15 words", "HOST.invalid", "51.added.md"):
        assert part in message


def test_workflows_and_nox_name_the_same_sessions():
    sessions = set(re.findall(r"^@nox\.session.*\ndef (\w+)", (ROOT / "noxfile.py").read_text("utf-8"), re.MULTILINE))
    workflow = (ROOT / ".github" / "workflows" / "ci.yml").read_text("utf-8")
    listed = re.search(r"session: \[(.*)\]", workflow)
    called = set(listed[1].split(", ")) | set(re.findall(r"nox -s (\w+)$", workflow, re.MULTILINE))
    assert called == sessions
    script = (ROOT / ".ci" / "run").read_text("utf-8")
    local = set(re.search(r"^nox .* -s (.*)$", script, re.MULTILINE)[1].split())
    assert local == sessions - {"tests", "versions"}
