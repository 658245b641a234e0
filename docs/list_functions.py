"""Write docs/functions.md from the registry: `python docs/list_functions.py`."""

from __future__ import annotations

from pathlib import Path

from xlmc.compile.choices import CHOICES
from xlmc.compile.lambdas import LAMBDAS
from xlmc.compile.places import PLACES
from xlmc.functions.families import REGISTRY

PAGE = Path(__file__).with_name("functions.md")

RANGES = """## Ranges in plain formulas

A formula that was entered neither with Ctrl-Shift-Enter nor as a dynamic array takes, of a range that stands where
one value is wanted, the cell beside the formula: in its row of a column, in its column of a row, else `#VALUE!`. Some
arguments have what is computed in them taken cell by cell all the same. Excel's file format keeps this for each
argument of each function as its class: reference, value or array ("OpenOffice.org's Documentation of the Microsoft
Excel File Format", section 3.2). The rows of the registry keep it too. What is computed of ranges is taken

- cell by cell in all arguments of `SUMPRODUCT`, `MMULT`, `MDETERM`, `MINVERSE`, `FREQUENCY`, `MODE`, `CORREL`,
  `COVAR`, `SLOPE` and kin, `SUMX2MY2` and kin, `CHITEST` and `FTEST`; in the data of `INDEX`, `LOOKUP`, `LINEST`,
  `LOGEST`, `TREND`, `GROWTH`, `FORECAST`, `IRR`, `MIRR`, `PROB`, `TTEST` and `AGGREGATE` 14 to 19; and in the ranges
  of `XLOOKUP`, `XMATCH`, `FILTER`, `SORT` and the other dynamic-array functions;
- as the cell beside the formula, even within `SUMPRODUCT`, in conditions and branches of `IF`, `IFS`, `SWITCH`,
  `CHOOSE`, `IFERROR` and `IFNA`, in the arguments of `VLOOKUP`, `HLOOKUP` and `TRANSPOSE`, and in the numbers of
  `INDEX`. A range that is a branch, or the table of `VLOOKUP`, stays whole;
- as around the call in all others, such as `SUM`, `AND`, `LARGE`, `MATCH`, `NPV`: cell by cell within `SUMPRODUCT`,
  else as the cell beside the formula.

So `SUM(INDEX((C1:C3>3)*C1:C3,0))` and `MATCH(1,INDEX((A1:A3="x")*(B1:B3=3),0),0)` need no Ctrl-Shift-Enter, and
`SUMPRODUCT(IF(C1:C3>3,C1:C3))` needs it. In `VLOOKUP`, `CHOOSE({1,2},A1:A3,B1:B3)` does not need it, and
`CHOOSE({1,2},A1:A3&C1:C3,B1:B3)` does. `OFFSET` that leads to several places at once is refused. A row or column
number 0 of `INDEX` gives the same whether it is typed or drawn.

## Hidden rows and spilled ranges

`SUBTOTAL` 1 to 11 leaves out the rows that a filter hides, and counts those hidden by hand; 101 to 111 leave out both.
The file marks both alike: a hidden row counts as filtered where it lies within a filter, of the sheet or of a table,
that has a condition. An advanced filter leaves no such condition in the file, so that the rows it hides count as hidden
by hand; `xlmc verify` shows where the saved value says otherwise. Where rows are hidden and the function number of
`SUBTOTAL` varies, it is refused.

`A1#` is the range that the dynamic array in A1 fills, `#REF!` where there is none (an array formula entered with
Ctrl-Shift-Enter does not spill). Where its size varies, it is what the formula gives in each trial.
"""

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

Formulas filled down over ranges that begin at one cell, as `=SUM(B$1:B7)`, `=MAX(A$1:B7)` and the same with `COUNT`,
`COUNTA`, `MIN`, `AVERAGE` and `PRODUCT`, take one step a row, to the same numbers. So do those over ranges that end at
one cell, as `=SUM(B7:B$5000)`: where 64 or more end there, their sums, means and products are taken from the last row
up, and may differ from Excel's by their rounding, in the last of 17 digits.

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
    return "\n".join([*lines, RANGES, LIMITS])


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
