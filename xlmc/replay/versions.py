"""What a newer xlmc computes otherwise than the one that made a run, and how to have the older one again."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import xlmc

if TYPE_CHECKING:
    from xlmc.record import Record

__all__ = ["RULES", "Rule", "install", "recorded_version", "rules_since"]


@dataclass(frozen=True, slots=True)
class Rule:
    """One way in which results changed.

    Attributes:
        since: the version that computes otherwise than those before.
        said: what it does now, in words.
        met: what a formula or another content of a cell looks like that it may concern.
    """

    since: str
    said: str
    met: re.Pattern[str]


def _calls(*names: str) -> re.Pattern[str]:
    return re.compile(rf"(?<![\w.])(?:{'|'.join(map(re.escape, names))})\(", re.IGNORECASE)


RULES: Final = (
    Rule("0.2.0", "TRUNC rounds, exactly, the 15 digits that Excel shows", _calls("TRUNC")),
    Rule("0.2.0", "CB.GetCertaintyFN gives percent", _calls("CB.GetCertaintyFN")),
)

_COMMITS: Final = {"0.1.0": "d3e17ac5424b50737653deb8db6e08c4a44ef1d3"}
"""The last commit of each version before this one."""


def recorded_version(record: Record) -> str:
    """The xlmc that made a run; of records that do not name it, nothing."""
    try:
        return str(record["software.xlmc"])
    except KeyError:
        return ""


def rules_since(version: str, contents: Iterable[str]) -> tuple[Rule, ...]:
    """The rules that changed after a version and that may concern a workbook.

    Args:
        version: the one that made a run, such as `0.1.0`.
        contents: of the cells that the run needed.
    """
    texts = tuple(contents)
    return tuple(
        rule
        for rule in RULES
        if _parts(version) < _parts(rule.since) <= _parts(xlmc.__version__)
        and any(rule.met.search(text) for text in texts)
    )


def install(version: str) -> str:
    """What to type, in a clone of xlmc's repository, to have a version beside this one."""
    folder = f"../xlmc-{version}"
    return (
        f"git worktree add {folder} {_COMMITS.get(version, f'v{version}')} && python3 -m venv {folder}/.venv && "
        f"{folder}/.venv/bin/pip install {folder}"
    )


def _parts(version: str) -> tuple[int, ...]:
    """A version as numbers that can be compared; what is no number ends it."""
    return tuple(int(part) for part in re.match(r"\d*(?:\.\d+)*", version)[0].split(".") if part)  # type: ignore[index]
