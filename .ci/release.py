"""Steps of a release that need the changelog and the history: `python .ci/release.py tags|check`."""

from __future__ import annotations

import re
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
_COMMIT = re.compile(r"^## (\S+)\n\nLast commit: ([0-9a-f]{40})$", re.MULTILINE)
_SECTION = re.compile(r"^## (\S+)(?: - (\d{4}-\d\d-\d\d))?$", re.MULTILINE)
_LONGEST = 15
_PLACEHOLDER = "HOST.invalid"


def git(*arguments: str) -> str:
    """Return what git says.

    Raises:
        CalledProcessError: it fails.
    """
    done = subprocess.run(["git", "-C", str(ROOT), *arguments], capture_output=True, encoding="utf-8", check=True)
    return done.stdout.strip()


def last_commits() -> dict[str, str]:
    """Return the last commit of every version that the archive of the changelog names."""
    return dict(_COMMIT.findall((ROOT / "CHANGELOG-archive.md").read_text(encoding="utf-8")))


def tags() -> None:
    """Make an annotated tag `vVERSION` for every version of the archive that has none, dated as its last commit.

    Raises:
        SystemExit: a commit does not state its version, or a tag names another commit.
    """
    known = set(git("tag", "--list", "v*").split())
    for version, commit in last_commits().items():
        tag = f"v{version}"
        if f'version = "{version}"' not in git("show", f"{commit}:pyproject.toml"):
            raise SystemExit(f"{commit} is not of version {version}")
        if tag in known:
            if git("rev-list", "-n", "1", tag) != commit:
                raise SystemExit(f"{tag} is not {commit}")
            continue
        git("tag", "--annotate", tag, commit, "--message", f"xlmc {version}")
        print(f"{tag} is {commit}")


def faults() -> Iterator[str]:
    """Yield what keeps the tree from being released."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    changelog = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    sections = _SECTION.findall(changelog)
    if not sections or sections[0][0] != project["version"]:
        yield f"CHANGELOG.md does not begin with {project['version']}"
    yield from (f"CHANGELOG.md gives {version} no date" for version, date in sections if not date)
    lines = re.findall(r"^- .*(?:\n  .*)*", changelog, re.MULTILINE)
    words = sorted(len(line.split()) - 1 for line in lines)
    if words and words[len(words) // 2] >= _LONGEST:
        yield f"half of the entries of CHANGELOG.md have {_LONGEST} words and more"
    if any(_PLACEHOLDER in address for address in project["urls"].values()):
        yield f"pyproject.toml has the placeholder {_PLACEHOLDER} under [project.urls]"
    fragments = [path.name for path in (ROOT / "changes").glob("*.md") if path.name != "README.md"]
    if fragments:
        yield f"changes/ holds fragments: run towncrier build ({', '.join(fragments)})"


def check() -> None:
    """Refuse to release a tree that is not ready.

    Raises:
        SystemExit: it is not; the message says why.
    """
    result = list(faults())
    if result:
        raise SystemExit("not ready for a release:\n" + "\n".join(f"  {fault}" for fault in result))
    print("ready for a release")


if __name__ == "__main__":
    {"tags": tags, "check": check}[sys.argv[1]]()
