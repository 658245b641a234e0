"""Write docs/functions.md from the registry: `python docs/list_functions.py`."""

from __future__ import annotations

from pathlib import Path

from xlmc.engine.graph.choices import CHOICES
from xlmc.engine.graph.lambdas import LAMBDAS
from xlmc.engine.graph.lowering import WRITTEN_OUT
from xlmc.engine.graph.reference_functions import REFERENCE_FUNCTIONS
from xlmc.excel.functions.families import REGISTRY

PAGE = Path(__file__).with_name("functions.md")

RANGES = """## Ranges in plain formulas

Take a formula that was entered neither with Ctrl-Shift-Enter nor as a dynamic array. Where it has a range but one value
is wanted, it uses the cell beside the formula: of a column the one in its row, of a row the one in its column, else
`#VALUE!`. But what is computed in some arguments is taken cell by cell. Excel's file format stores this for each
argument of each function as its class: reference, value or array ("OpenOffice.org's Documentation of the Microsoft
Excel File Format", section 3.2). xlmc has the same classes. A calculation with ranges is taken

- cell by cell in all arguments of `SUMPRODUCT`, `MMULT`, `MDETERM`, `MINVERSE`, `FREQUENCY`, `MODE`, `CORREL`, `COVAR`,
  `SLOPE` and similar ones, `SUMX2MY2` and similar ones, `CHITEST` and `FTEST`; in the data of `INDEX`, `LOOKUP`,
  `LINEST`, `LOGEST`, `TREND`, `GROWTH`, `FORECAST`, `IRR`, `MIRR`, `PROB`, `TTEST` and `AGGREGATE` 14 to 19; and in the
  ranges of `XLOOKUP`, `XMATCH`, `FILTER`, `SORT` and the other dynamic-array functions;
- as the cell beside the formula, even within `SUMPRODUCT`, in conditions and branches of `IF`, `IFS`, `SWITCH`,
  `CHOOSE`, `IFERROR` and `IFNA`, in the arguments of `VLOOKUP`, `HLOOKUP` and `TRANSPOSE`, and in the numbers of
  `INDEX`. A range that is a branch, or the table of `VLOOKUP`, stays whole;
- in the same way as the call itself in all others, such as `SUM`, `AND`, `LARGE`, `MATCH`, `NPV`: cell by cell within
  `SUMPRODUCT`, else as the cell beside the formula.

So `SUM(INDEX((C1:C3>3)*C1:C3,0))` and `MATCH(1,INDEX((A1:A3="x")*(B1:B3=3),0),0)` need no Ctrl-Shift-Enter, and
`SUMPRODUCT(IF(C1:C3>3,C1:C3))` needs it. In `VLOOKUP`, `CHOOSE({1,2},A1:A3,B1:B3)` does not need it, and
`CHOOSE({1,2},A1:A3&C1:C3,B1:B3)` does. `OFFSET` that leads to several ranges at once is refused. A row or column
number 0 of `INDEX` gives the same whether it is typed or drawn. With one number, `INDEX` gives a row of an array, but
`#REF!` for a reference of several rows and columns, as in Excel.

The functions of the former Analysis ToolPak, such as `EDATE`, `EOMONTH`, `WEEKNUM`, `YEARFRAC`, `NETWORKDAYS`, `ISODD`,
`MROUND`, `QUOTIENT`, `CONVERT`, `DEC2BIN`, `IMABS`, `BESSELJ`, `ERF`, `PRICE` and similar ones, and `NETWORKDAYS.INTL`
and `WORKDAY.INTL`, give `#VALUE!` for a range of several cells where one value is wanted: in plain formulas, array
formulas and dynamic arrays, and within `SUMPRODUCT`. Arrays are computed element by element. So
`SUMPRODUCT(--(WEEKNUM(A1:A3)=1))` is `#VALUE!`, and `SUMPRODUCT(--(WEEKNUM(+A1:A3)=1))` is a count. Holidays, the
payments and dates of `XIRR` and `XNPV`, and the arguments of `GCD`, `LCM`, `MULTINOMIAL`, `IMSUM` and `IMPRODUCT` take
ranges.

## Hidden rows and spilled ranges

`SUBTOTAL` 1 to 11 leaves out the rows that a filter hides, and counts those hidden by hand; 101 to 111 leave out both.
The file marks both in the same way: a hidden row counts as filtered if it lies within a filter, of the sheet or of a
table, that has a condition. An advanced filter leaves no condition in the file, so the rows it hides count as hidden by
hand; `xlmc verify` shows where the saved value contradicts this. Where rows are hidden and the function number of
`SUBTOTAL` varies, it is refused.

`MATCH` with -1 goes down from the first cell, over cells of another kind, and ends at the first equal or smaller one;
the other approximate lookups halve the range, as Excel does also where it is in no order. In an array that is no range,
such as `{1;TRUE}`, `AVERAGEA` and its like count no logicals, and no texts but for `AVERAGEA`. In patterns a `~` takes
the next character as it is.

`GETPIVOTDATA` reads the cell of the pivot table, as Excel last refreshed it: a run refreshes nothing, and a pivot table
whose source varies is refused. Items may vary; fields, and which pivot table, may not.

`A1#` is the range that the dynamic array in A1 fills, or `#REF!` if there is none (an array formula entered with
Ctrl-Shift-Enter does not spill). Where its size varies, it is what the formula gives in each trial.

Formulas may also name the cells that a dynamic array fills, `SUM(A1:A4)`; in a trial in which it fills fewer, the
others are blank. In the file stands only how many it filled when it was saved. If it may fill more in some trials, a
formula that names the blank cells below it (beside it, for a single row of several cells) is refused: write `A1#`.
"""

DIGITS = """## Excel's 15 digits

Numbers are doubles, in Excel as here. Excel hides their last bits in three places, and so does xlmc, in constants and
in each trial, with the engines `numpy` and `jit` alike:

- `=` `<>` `<` `<=` `>` `>=` between numbers compare both rounded to 15 significant decimal digits, halves away from
  zero. `0.1+0.2=0.3` and `1-0.9=0.1` are TRUE, `1.1*3>3.3` is FALSE, `10.1-10=0.1` is FALSE (the 15th digit differs).
  Texts and logicals are compared as usual.
- The last `+` or `-` of a cell's formula gives 0 where the size of the result is less than 8 units in the last place of
  its first number: `=0.5-0.4-0.1` is 0. In brackets, `=(0.5-0.4-0.1)`, or where another operation or a function comes
  last, `=1*(0.5-0.4-0.1)` and `=0.5-0.4-0.1+0`, it is -2.78E-17. In an array formula the rule holds for each cell; the
  formula of a defined name is not a cell's. No source confirms these two.
- A sum or difference is that of the doubles everywhere else.
- A number below 2^-1022 (2.2250738585072014E-308) in size is 0, as a result, as a cell's value, as a text that is read
  as a number and as a draw: `=1/(1E-160*1E-150)` is `#DIV/0!` (Microsoft, article 78113). With the engine `numpy` one
  result is an exception: within a formula, the difference of two numbers that are below 1E-291 themselves.

Criteria, such as those of `COUNTIF`, `SUMIFS` and `DSUM`, compare numbers so, too: a text that a formula joins
(`">"&A1`) holds no more of a number, and books that Excel saved show that the cells are compared so as well. Of a
criterion that is a plain number, only equality is compared.

All bits are kept by `MATCH`, `XLOOKUP` and the other lookups, `SWITCH` and `CHOOSE`, `SUM` (which Excel makes 0 in some
cases and not in others, by no rule that is known), and the limits in the tables of xlmc. Bounds, derivatives, `xlmc
stability` and its recomputation with 50 digits change neither the last sum nor small numbers. LibreOffice differs: it
makes every sum 0 that cancels to some 16 units, also in brackets.

Sources. Comparisons: Apache POI, `NumberComparer` and the doubles at which Excel's answer changes in its
`NumberComparisonExamples` (all 33 steps are met to the last bit); S. Byrne, Stack Overflow 40293983. The last sum:
joeu2004 and J. W. Lewis, microsoft.public.excel.worksheet.functions, April 2009 (1 to 7 units give 0, 8 do not,
from 1E-7 to 1E308); S. Byrne, who names the first number; forum.bebac.at 22126 (`=0=0.5-0.4-0.1` is FALSE). Microsoft's
article 78113 says no more than "at or very close to zero". Lookups: Microsoft Answers 11355118.
"""

DIFFERENCES = """## What differs from Excel on purpose

- `ERF`, `GAMMALN`, `BESSELI` and similar ones, distributions and their inverses are right to the last digits of a
  double, where Excel's own have 7 to 15 right digits.
- `SIN`, `COS` and `TAN` are exact near multiples of pi/2: `COS(PI()/2)` is 6.123E-17. 32-bit Excel gives 6.126E-17;
  `xlmc verify` takes either.
- Dates and numbers as texts, and `TEXT`, are as in Excel for the United States: month before day, points for decimals.
  `ASC` leaves every text as it is: full-width letters change only in Chinese, Japanese and Korean versions.
  A book does not hold the settings of the machine that it was last opened on. A date without its year is `#VALUE!`:
  it would be one of the year of the run.
- A function or a name that Excel does not know is `#NAME?` only if the file confirms it: the value that Excel saved is
  `#NAME?`, or what the formula makes of that error (`IFERROR(NOSUCH(1),0)`); the book has no code of its own; and the
  function has no mark of an add-in or of a newer Excel. `xlmc check` says so. In all other cases it is refused.
- A `LAMBDA` with the name of an Excel function, such as `Sum`, is never called by that name: `Sum(2)` is `SUM`. A
  function that is newer than Excel 2007 has the mark `_xlfn.` in the file; without the mark the name means the
  `LAMBDA`. No source confirms this for a `LAMBDA`: Excel treats names of ranges, and of functions in Visual Basic, in
  this way.
- `NOW` and `TODAY` are what Excel saved, so that a run can be repeated. `RAND`, `RANDBETWEEN` and `RANDARRAY` are
  assumptions, drawn anew in each trial.
- Formulas that read other workbooks get the values that Excel stored in this one, with a notice. Where Excel computes
  with precision as displayed, xlmc computes with full precision, with a notice.
- Refused are `OFFSET`, `INDIRECT` and `INDEX(…):INDEX(…)` that lead to other cells in each trial (use `TAKE` or `DROP`,
  which accept numbers that vary); `MAKEARRAY` of a size that varies (`SEQUENCE` accepts one); a `LAMBDA` that calls
  itself with changing ranges or arrays more than 60 calls deep.
- A cell is in a circle where its own value is read while it is computed, in each trial anew: `SUM(A2:OFFSET(A6,-1,0))`
  in A6 and `CHOOSE(2,B40,"x")` in B40 are computed. Where a condition or a criterion that varies has the own cell read,
  the trials that read it are errors, `#CALC!`, with a notice. What would hide such an error (`IFERROR`, `COUNT`) is
  refused, and so are more than eight cells that may each read another one in each trial.
- Where Excel's iterative calculation is on (File, Options, Formulas), cells that read themselves are computed as often
  as the workbook says (100 times), until no cell of the circle changes by as much as its maximum change (.001). Every
  trial starts from the values that Excel saved in them (an empty cell is 0), and Excel itself from what the last
  calculation left. In each iteration the cells are computed by tab, row and column, each from what the others hold by
  then. Microsoft documents no order. A notice says that cells are iterated, and in how many trials they do not settle;
  `xlmc stability` says whether the answer depends on the start. Array formulas in a circle are refused.
- Sums from the last row up are rounded in another order where 64 or more of them end at one cell (below).
- Microsoft does not document these, and Excel may do otherwise: `AND("",…)`; `XLOOKUP` of the nearest across numbers
  and texts; which of several equal keys a binary search finds; `ACCRINT` with FALSE for its method after the first
  coupon; `YEARFRAC` of basis 1 in 1900; and `WORKDAY.INTL` of a range of several dates, which is `#VALUE!` here.
"""

LIMITS = """## Limits

A workbook may need more memory than a machine has. xlmc checks before it takes memory, and refuses with the cell, the
size and what to do (exit code 2). If the cell depends on no assumption and Excel saved its value, that value is used,
with a notice. Whole columns and rows, and ranges that go far beyond the last filled cell, are read up to that cell and
keep their size: the empty cells beyond are counted, not read. A function that would need them one by one, such as
`SORT` or `TRANSPOSE`, is refused.

| what | limit |
|---|---|
| cells of one array (`SEQUENCE`, `MMULT`, `VSTACK`, a column times a row) | 8,388,608 |
| cells of one range of a sheet | 2,097,152 |
| cells taken one by one, as texts are, in one array | 2,097,152 |
| characters of all texts of one array | 67,108,864 |
| calls of `LAMBDA`s in one formula; in all formulas | 100,000; 500,000 |
| calls of a `LAMBDA` by itself, within each other | 16,384 / (its parameters + 1); deeper is `#NUM!`, as in Excel |
| steps of all such calls, from 60 within each other or 1,000 in all | 100,000 |
| steps of one `MMULT`, `MDETERM` or `MINVERSE` | 2,147,483,648 |
| memory of constant arrays at a time, each once; of all arrays of a block of trials | 256 MB each |
| characters of a formula as the file holds it (Excel: 8,192 as it shows it) | 32,768 |
| levels of a formula with its names written out (Excel: 64 calls) | 200 |
| arguments of a function | 255, as in Excel |
| characters of a text | 32,767, as in Excel: a longer one is `#VALUE!` |

Formulas filled down over ranges that begin at one cell, as `=SUM(B$1:B7)`, `=MAX(A$1:B7)` and the same with `COUNT`,
`COUNTA`, `MIN`, `AVERAGE` and `PRODUCT`, take one step for each row, and give the same numbers. So do those over ranges
that end at one cell, as `=SUM(B7:B$5000)`. Where 64 or more end there, their sums, means and products are computed from
the last row up, and may differ from Excel's in the last of 17 digits.

The first limits count one trial. Where arrays are large, fewer trials are evaluated at a time, with the same results.
"""


def names() -> list[str]:
    """Every function of Excel that xlmc computes, in alphabetical order."""
    internal = {"SINGLE", "ANCHORARRAY"}
    known = {*REGISTRY, *CHOICES, *REFERENCE_FUNCTIONS, *LAMBDAS, *WRITTEN_OUT, "LET", "LAMBDA"} - internal
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
        "one, or `OFFSET` and `INDIRECT` with arguments that vary, `xlmc check` names its cell; where that cell",
        "depends on no assumption, the value that Excel saved is used, with a note.",
        "",
        "This page is written by `python docs/list_functions.py`.",
        "",
    ]
    lines += [f"**{letter}** {' '.join(f'`{name}`' for name in result)}\n" for letter, result in letters.items()]
    return "\n".join([*lines, RANGES, DIGITS, DIFFERENCES, LIMITS])


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
