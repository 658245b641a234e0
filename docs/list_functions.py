"""Write docs/functions.md from the registry: `python docs/list_functions.py`."""

from __future__ import annotations

from pathlib import Path

from xlmc.compile.choices import CHOICES
from xlmc.compile.lambdas import LAMBDAS
from xlmc.compile.places import PLACES
from xlmc.functions.families import REGISTRY

PAGE = Path(__file__).with_name("functions.md")

LIMITS = """## Limits

A workbook may ask for more than a machine has. xlmc asks before it takes memory, and refuses with the cell, the size
and what to do (exit code 2); where no assumption reaches the cell and Excel saved its value, that value is used, with a
notice. Whole columns and rows, and ranges that go on far beyond the last filled cell, are read up to that cell and keep
their size: the empty cells beyond are counted, not read. A function that would take them one by one, such as `SORT` or
`TRANSPOSE`, is refused.

| what | limit |
|---|---|
| cells of one array (`SEQUENCE`, `MMULT`, `VSTACK`, a column times a row) | 8,388,608 |
| cells of one range of a sheet | 2,097,152 |
| cells taken one by one, as texts are, in one array | 2,097,152 |
| characters of all texts of one array | 67,108,864 |
| calls of `LAMBDA`s in one formula; in all formulas | 100,000; 500,000 |
| steps of one `MMULT`, `MDETERM` or `MINVERSE` | 2,147,483,648 |
| memory of all constant arrays; of all arrays of a block of trials | 256 MB each |
| characters of a formula as the file holds it (Excel: 8,192 as it shows it) | 32,768 |
| levels of a formula with its names written out (Excel: 64 calls) | 200 |
| arguments of a function | 255, as in Excel |
| characters of a text | 32,767, as in Excel: a longer one is `#VALUE!` |

The first limits count one trial. Where arrays are large, fewer trials are evaluated at a time, to the same numbers.
"""


def names() -> list[str]:
    """Every function of Excel that xlmc computes, in alphabetical order."""
    internal = {"SINGLE", "ANCHORARRAY"}
    known = {*REGISTRY, *CHOICES, *PLACES, *LAMBDAS, "LET", "LAMBDA"} - internal
    return sorted(name for name in known if name[0].isalpha() and name == name.upper())


def page() -> str:
    """The page's text."""
    letters: dict[str, list[str]] = {}
    for name in names():
        letters.setdefault(name[0], []).append(name)
    lines = [
        "# Functions",
        "",
        f"xlmc computes these {len(names())} functions of Excel, for all trials at once. Where a formula uses another",
        "one, or `OFFSET` and `INDIRECT` with arguments that vary, `xlmc check` names its cell; where no assumption",
        "reaches that cell, the value that Excel saved is used, with a note.",
        "",
        "This page is written by `python docs/list_functions.py`.",
        "",
    ]
    lines += [f"**{letter}** {' '.join(f'`{name}`' for name in found)}\n" for letter, found in letters.items()]
    return "\n".join([*lines, LIMITS])


if __name__ == "__main__":
    PAGE.write_text(page())
