"""Books of thousands of lookups in one table: whole columns beside bounded ranges, texts beside numbers.

`python benchmarks/lookups.py` makes books with 7,274 lookups in a table of 3,000 rows, as a price list is used, each in
whole columns (`Table!A:C`) and in a bounded range (`Table!$A$1:$C$3000`), exact and approximate. It prints the seconds
of processor time, from the workbook on, that it takes to recompute and compare all cells (`xlmc verify --all`). Keys
that a drawn number moves take a tenth of the lookups and 2,048 trials. Each book is measured in a process of its own.
Constant keys give what Python's own bisection gives, or the script ends with an error. The limit is 10 s for each book.
`--lookups` and `--rows` ask for less.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
from bisect import bisect_right
from collections.abc import Iterator
from itertools import product
from pathlib import Path
from time import process_time
from typing import Any, Final, NamedTuple

LOOKUPS, ROWS, TRIALS = 7_274, 3_000, 2_048
LIMIT = 10.0
STEP = 7
"""From one key to the next, so that all rows are looked for."""


class Case(NamedTuple):
    """One book."""

    form: str
    whole: bool
    texts: bool
    drawn: bool


FORMS: Final = {
    "VLOOKUP, exact": "VLOOKUP({key},{table},3,FALSE)",
    "VLOOKUP, approximate": "VLOOKUP({key},{table},3,TRUE)",
    "INDEX and MATCH": "INDEX({prices},MATCH({key},{names},0))",
    "MATCH, approximate": "MATCH({key},{names},1)",
    "XLOOKUP": "_xlfn.XLOOKUP({key},{names},{prices})",
    "COUNTIF": "COUNTIF({names},{key})",
}


def cases() -> Iterator[Case]:
    """All of them."""
    for form, texts, drawn, whole in product(FORMS, (True, False), (False, True), (True, False)):
        yield Case(form, whole, texts, drawn)


def name_of(row: int, texts: bool) -> str | float:
    """The entry of a row of the table, in rising order for texts and numbers."""
    return f"Item {row:05d}" if texts else 10.0 * row


def expected(case: Case, key: str | float, rows: int) -> float:
    """What a lookup of a key in the table must give."""
    names = [name_of(row, case.texts) for row in range(rows)]
    at = bisect_right(names, key) - 1  # type: ignore[type-var]  # all of one kind
    if case.form == "COUNTIF":
        return float(key in names)
    return float(at + 1) if case.form.startswith("MATCH") else 0.5 * at


def make_book(path: Path, case: Case, lookups: int, rows: int) -> None:
    """Write a book with the values that its formulas should have."""
    import xlsxwriter

    book = xlsxwriter.Workbook(path)
    model, table = book.add_worksheet("Model"), book.add_worksheet("Table")
    for row in range(rows):
        table.write_row(row, 0, [name_of(row, case.texts), f"unit {row % 7}", 0.5 * row])
    places = {"table": "Table!A:C", "names": "Table!A:A", "prices": "Table!C:C"}
    if not case.whole:
        places = {"table": f"Table!$A$1:$C${rows}", "names": f"Table!$A$1:$A${rows}", "prices": f"Table!$C$1:$C${rows}"}
    model.write_number(0, 0, 0.5)
    for number in range(lookups):
        line = number + 1
        key = name_of(number * STEP % rows, case.texts)
        moved = f"MOD({number * STEP}+INT($A$1*100),{rows})"
        if case.drawn:
            model.write_formula(line, 0, f"=INDEX(Table!$A$1:$A${rows},1+{moved})", None, 0)
        else:
            model.write(line, 0, key)
        result = expected(case, key, rows) if not case.drawn else 0
        model.write_formula(line, 1, "=" + FORMS[case.form].format(key=f"A{line + 1}", **places), None, result)
    model.write_formula(0, 1, f"=SUM(B2:B{lookups + 1})", None, 0)
    model.add_table(0, 4, 1, 7, _table("xlmc_assumptions", "Name", "Cell", "Low", "High"))
    model.write_row(1, 4, ["shift"])
    model.write_formula(1, 5, "=Model!A1")
    model.write_row(1, 6, [0.0, 1.0])
    model.add_table(4, 4, 5, 5, _table("xlmc_forecasts", "Name", "Cell"))
    model.write_row(5, 4, ["sum"])
    model.write_formula(5, 5, "=Model!B1")
    book.close()


def _table(name: str, *headings: str) -> dict[str, object]:
    return {"name": name, "columns": [{"header": heading} for heading in headings]}


def measure(path: str, *, drawn: bool) -> float:
    """Seconds from the workbook to the answer, imports not counted.

    Raises:
        ArithmeticError: a lookup of a constant gives something else than Python does.
    """
    from xlmc.analysis.studies.verify import Status, verify
    from xlmc.excel.workbook.reader import read_workbook
    from xlmc.montecarlo.definitions.run_options import RunOptions
    from xlmc.montecarlo.model.loading import load
    from xlmc.montecarlo.simulation.simulate import run_model

    start = process_time()
    if drawn:
        run_model(load(path), RunOptions.of(trials=TRIALS))
        return process_time() - start
    result = verify(read_workbook(Path(path)))
    used = process_time() - start
    lookups = [each for each in result.cells if each.cell.column == 2 and each.cell.row > 1]
    if not lookups or (wrong := [each for each in lookups if each.status is not Status.MATCHED]):
        raise ArithmeticError(f"{len(wrong)} of {len(lookups)} lookups differ: {wrong[:1]}")
    return used


def main() -> int:
    """Print the table; 1 where a book takes longer than the limit."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--lookups", type=int, default=LOOKUPS)
    parser.add_argument("--rows", type=int, default=ROWS)
    parser.add_argument("--only", help="a form alone")
    parser.add_argument("--measure", nargs=2, metavar=("BOOK", "DRAWN"), help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.measure:
        print(measure(given.measure[0], drawn=json.loads(given.measure[1])))
        return 0
    print(f"| {given.lookups:,} lookups in {given.rows:,} rows | of | keys | whole columns, s | bounded, s |")
    print("|---|---|---|---:|---:|", flush=True)
    longest = 0.0
    with tempfile.TemporaryDirectory() as folder:
        rows: dict[tuple[Any, ...], list[float]] = {}
        for case in cases():
            if given.only not in (None, case.form):
                continue
            path = Path(folder, "lookups.xlsx")
            make_book(path, case, given.lookups // (10 if case.drawn else 1), given.rows)
            taken = rows.setdefault((case.form, case.texts, case.drawn), [])
            taken.append(_fresh(path, case.drawn))
            longest = max(longest, taken[-1])
            if len(taken) == 2:
                of, keys = "texts" if case.texts else "numbers", "drawn" if case.drawn else "constant"
                print(f"| {case.form} | {of} | {keys} | {taken[0]:.1f} | {taken[1]:.1f} |", flush=True)
    return int(longest > LIMIT)


def _fresh(path: Path, drawn: bool) -> float:
    command = [sys.executable, __file__, "--measure", str(path), json.dumps(drawn)]
    return float(subprocess.run(command, check=True, capture_output=True, text=True).stdout)


if __name__ == "__main__":
    sys.exit(main())
