"""A run of the tests leaves the tree as it found it: files that appeared, changed or went are named, and it fails."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

import pytest

NOT_LOOKED_INTO = {
    *(".git", ".hypothesis", ".mypy_cache", ".pytest_cache", ".ruff_cache", "__pycache__"),
    ".peers",  # what benchmarks install
}
"""Caches; neither is a virtual environment looked into."""

Tree = dict[str, tuple[int, int]]
_BEFORE = pytest.StashKey[Tree]()
_CHANGES = pytest.StashKey[list[str]]()


def _files(folder: Path) -> Iterator[os.DirEntry[str]]:
    with os.scandir(folder) as entries:
        for entry in entries:
            if not entry.is_dir(follow_symlinks=False):
                yield entry
            elif _is_looked_into(entry):
                yield from _files(Path(entry.path))


def _is_looked_into(folder: os.DirEntry[str]) -> bool:
    cache = folder.name in NOT_LOOKED_INTO or folder.name.endswith(".egg-info")
    return not cache and not os.path.exists(os.path.join(folder.path, "pyvenv.cfg"))


def snapshot(root: Path) -> Tree:
    """Every file under `root`, whatever git ignores -> its size in bytes and the time it was written, in ns."""
    stats = ((entry.path, entry.stat(follow_symlinks=False)) for entry in _files(root))
    return {os.path.relpath(path, root): (stat.st_size, stat.st_mtime_ns) for path, stat in stats}


def changes(before: Tree, after: Tree) -> list[str]:
    """What happened to which file, in the order of their names."""
    names = sorted(name for name in before.keys() | after.keys() if before.get(name) != after.get(name))
    return [f"{'appeared' if n not in before else 'is gone' if n not in after else 'changed'}: {n}" for n in names]


def pytest_sessionstart(session: pytest.Session) -> None:
    if not hasattr(session.config, "workerinput"):  # one look for all processes
        session.config.stash[_BEFORE] = snapshot(session.config.rootpath)


@pytest.hookimpl(trylast=True)  # when the workers are done
def pytest_sessionfinish(session: pytest.Session) -> None:
    result = session.config.stash.get(_BEFORE, None)
    if result is not None:
        session.config.stash[_CHANGES] = message = changes(result, snapshot(session.config.rootpath))
        if message and session.exitstatus in (pytest.ExitCode.OK, pytest.ExitCode.NO_TESTS_COLLECTED):
            session.exitstatus = pytest.ExitCode.TESTS_FAILED


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter, config: pytest.Config) -> None:
    if message := config.stash.get(_CHANGES, []):
        terminalreporter.section("The tree is not as the tests found it", red=True)
        terminalreporter.write_line("A test writes to tmp_path. Unless you edited these files while the tests ran:")
        for line in message:
            terminalreporter.write_line(f"  {line}")
