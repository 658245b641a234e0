from __future__ import annotations

import os
import subprocess

import pytest
import two_versions


def _repository(folder):
    """Make a repository whose only commit has a package and a file that a later change removes."""

    def git(*arguments):
        who = ("-c", "user.name=a", "-c", "user.email=a@example.org")
        subprocess.run(["git", "-C", str(folder), *who, *arguments], check=True, capture_output=True)

    (folder / "xlmc").mkdir(parents=True)
    (folder / "xlmc" / "__init__.py").write_text("", encoding="utf-8")
    git("init", "--quiet")
    git("add", ".")
    git("commit", "--quiet", "-m", "first")
    (folder / "xlmc" / "__init__.py").unlink()
    return folder


def test_a_tree_is_a_path_or_a_revision(tmp_path, monkeypatch):
    repository = _repository(tmp_path / "repository")
    monkeypatch.setattr(two_versions, "ROOT", repository)
    with two_versions.tree_of(str(repository), tmp_path) as tree:
        assert tree == repository.resolve()
    with two_versions.tree_of("HEAD", tmp_path) as tree:
        assert (tree / "xlmc" / "__init__.py").exists()
        assert tree != repository
    assert not tree.exists()


def test_a_process_has_the_package_of_its_tree(tmp_path):
    tree = tmp_path / "tree"
    (tree / "xlmc").mkdir(parents=True)
    (tree / "xlmc" / "__main__.py").write_text("sum(range(2_000_000))", encoding="utf-8")
    assert two_versions.processor_time(tree, ("-m", "xlmc"), tmp_path) > 0
    refused = ("-c", "import sys; sys.stderr.write('nothing of this kind'); exit(2)")
    with pytest.raises(RuntimeError, match="nothing of this kind"):
        two_versions.processor_time(tree, refused, tmp_path)


def test_the_two_run_in_turn_and_a_first_run_does_not_count(tmp_path, monkeypatch):
    times = iter([99.0, 99.0, 3.0, 4.0, 1.0, 2.0, 2.0, 2.0])
    asked = []

    def measure(tree, arguments, folder):
        asked.append(tree.name)
        return next(times)

    monkeypatch.setattr(two_versions, "processor_time", measure)
    result = two_versions.ratio((tmp_path / "new", ()), (tmp_path / "old", ()), 3, tmp_path)
    assert result == (2.0, 2.0, 0.75)
    assert asked == ["new", "old"] * 4


def test_every_command_of_every_book_has_a_row(capsys, monkeypatch):
    books = [str(two_versions.CASE_STUDY), str(two_versions.CASE_STUDY.with_name("skid-100-ft.xlsx"))]
    monkeypatch.setattr(two_versions, "processor_time", lambda tree, arguments, folder: float(len(arguments)))
    monkeypatch.setattr(two_versions.machine, "describe", dict)
    monkeypatch.setattr(two_versions.machine, "sentence", lambda result: "A machine.")
    two_versions.main([os.fspath(two_versions.ROOT), "--books", *books, "--pairs", "1"])
    rows = [line for line in capsys.readouterr().out.splitlines() if "| 1.000 |" in line]
    assert [row.split("|")[1].strip() for row in rows] == ["intersection", "intersection", "skid-100-ft", "skid-100-ft"]
