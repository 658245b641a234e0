"""Sheet names: which are free, how formulas write them, and how to change them in formulas."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from itertools import count

__all__ = ["free_names", "free_table_name", "quoted", "renamed"]

_LONGEST = 31  # characters in a sheet name, Excel's limit

_TOKEN = re.compile(
    r"""
    (?P<text>"(?:[^"]|"")*")            # "text", which may look like a reference
  | '(?P<quoted>(?:[^']|'')*)'!         # 'My sheet'!
  | (?<![\w.\]\#])(?P<bare>[\w.\\]+)!   # Sheet!, but neither [1]Sheet! of another workbook nor #REF!
  | (?<![\w.\]])(?P<table>[\w.\\]+)(?=\[)   # Table[
    """,
    re.VERBOSE,
)


def free_names(wanted: Sequence[str], taken: Collection[str]) -> dict[str, str]:
    """A sheet name for each one wanted: itself, or `Results (2)` where the workbook has a sheet of that name."""
    used = {name.casefold() for name in taken}
    found: dict[str, str] = {}
    for name in wanted:
        found[name] = next(candidate for candidate in _numbered(name) if candidate.casefold() not in used)
        used.add(found[name].casefold())
    return found


def free_table_name(wanted: str, taken: Collection[str]) -> str:
    """The table name itself, or `Trials_2`. `taken` holds folded names of tables and of defined names alike."""
    candidates = (wanted if number == 1 else f"{wanted}_{number}" for number in count(1))
    return next(candidate for candidate in candidates if candidate.casefold() not in taken)


def quoted(name: str) -> str:
    """The name as a formula may always write it: `O'Hara -> 'O''Hara'`."""
    return "'" + name.replace("'", "''") + "'"


def renamed(formula: str, sheets: Mapping[str, str], tables: Mapping[str, str]) -> str:
    """The formula with sheets and tables called by their new names; strings and other workbooks' sheets stay.

    Keys of both mappings are folded old names.
    """

    def new(match: re.Match[str]) -> str:
        if match["text"] is not None:
            return match[0]
        if match["table"] is not None:
            return tables.get(match["table"].casefold(), match[0])
        name = match["bare"] if match["quoted"] is None else match["quoted"].replace("''", "'")
        changed = sheets.get(name.casefold())
        return match[0] if changed is None else f"{quoted(changed)}!"

    return _TOKEN.sub(new, formula)


def _numbered(name: str) -> Iterator[str]:
    yield name
    for number in count(2):
        suffix = f" ({number})"
        yield name[: _LONGEST - len(suffix)] + suffix
