"""Loading a large book of filled-down formulas: xlmc beside `formulas.ExcelModel`.

`python benchmarks/loading.py` makes books of 200 formula shapes filled down, loads and compiles each with xlmc (the
median of three), and loads it with `ExcelModel().loads(...)`, which compiles nothing yet, every run in a process of its
own. It prints seconds and the ratio at each size. The largest book takes `formulas` some minutes; `--most` leaves out
the larger ones.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
from pathlib import Path
from statistics import median
from time import process_time

SHAPES = 200
SIZES = (800, 3_200, 12_800, 50_000)


def make_book(path: Path, cells: int) -> None:
    """A sheet of SHAPES formula columns, filled down: inputs in the first two columns."""
    import xlsxwriter

    rows = cells // SHAPES
    book = xlsxwriter.Workbook(path)
    sheet = book.add_worksheet("Model")
    for row in range(rows):
        sheet.write_number(row, 0, 1.0 + row)
        sheet.write_number(row, 1, 2.0 + row)
        for column in range(2, SHAPES + 2):
            sheet.write_formula(row, column, formula(row + 1, column))
    sheet.add_table(rows + 2, 0, rows + 3, 3, _table("xlmc_assumptions", "Name", "Cell", "Low", "High"))
    sheet.write_row(rows + 3, 0, ["first"])
    sheet.write_formula(rows + 3, 1, "=Model!A1")
    sheet.write_row(rows + 3, 2, [0.5, 1.5])
    sheet.add_table(rows + 6, 0, rows + 7, 1, _table("xlmc_forecasts", "Name", "Cell"))
    sheet.write_row(rows + 7, 0, ["last"])
    sheet.write_formula(rows + 7, 1, f"=Model!{letters(SHAPES + 1)}{rows}")
    book.close()


def _table(name: str, *headings: str) -> dict[str, object]:
    return {"name": name, "columns": [{"header": heading} for heading in headings]}


def formula(row: int, column: int) -> str:
    """One of SHAPES shapes of five kinds: each needs the cells left of it, and some the row above."""
    left, further = f"{letters(column - 1)}{row}", f"{letters(column - 2)}{row}"
    above = f"{letters(column)}{row - 1}" if row > 1 else "$A$1"
    kinds = (
        f"={left}*0.5+{further}/{column}",
        f"=IF({left}>{further},{left}-{further},{column})",
        f"=SIN({left})*{column}+SQRT(ABS({further}))/({column}+ABS({above}))",
        f"=SUM({further}:{left})/{column}",
        f"=ROUND({left}+{above},2)-MAX({further},{column})",
    )
    return kinds[column % len(kinds)]


def letters(index: int) -> str:
    """Column letters, counted from 0."""
    from openpyxl.utils import get_column_letter

    return str(get_column_letter(index + 1))


def measure(contestant: str, path: str) -> float:
    """Seconds to load, and for xlmc to compile too, imports not counted."""
    if contestant == "xlmc":
        import xlmc

        start = process_time()
        from xlmc.montecarlo.model.loading import load

        model = load(path)
        model.program("numpy")
        assert xlmc.__version__
    else:
        import formulas

        start = process_time()
        formulas.ExcelModel().loads(path)
    return process_time() - start


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description="Seconds to load a large book, beside formulas.")
    parser.add_argument("--only", nargs=2, metavar=("CONTESTANT", "BOOK"), help="measure one, in this process")
    parser.add_argument("--most", type=int, default=SIZES[-1], help="formula cells of the largest book")
    chosen = parser.parse_args()
    if chosen.only:
        print(measure(*chosen.only))
        return
    print(f"{'formula cells':>14}{'xlmc, s':>12}{'formulas, s':>14}{'ratio':>10}")
    with tempfile.TemporaryDirectory() as folder:
        for size in (size for size in SIZES if size <= chosen.most):
            path = Path(folder) / f"{size}.xlsx"
            make_book(path, size)
            fast = [_fresh("xlmc", path), _fresh("xlmc", path)]
            slow = _fresh("formulas", path)
            seconds = median([*fast, _fresh("xlmc", path)])
            print(f"{size:>14,}{seconds:>12.3f}{slow:>14.2f}{slow / seconds:>10.0f}", flush=True)


def _fresh(contestant: str, path: Path) -> float:
    command = [sys.executable, __file__, "--only", contestant, str(path)]
    return float(subprocess.run(command, check=True, capture_output=True, text=True).stdout)


if __name__ == "__main__":
    main()
