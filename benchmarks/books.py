"""The workbooks that the contestants are measured on: `python benchmarks/books.py FOLDER` writes those that it makes.

- `case-study`: examples/intersection.xlsx, 17 assumptions, 42 needed formula cells, 3 filters, 4 forecasts.
- `skid`: a speed from a skid mark on a grade, 3 assumptions, 4 formula cells, 1 forecast.
- `cells-1000` and `cells-20000`: a vehicle brakes and steers over an uneven road, 20 formula cells a time step, 50 and
  1,000 steps: arithmetic, IF, SUM over ranges, lookups by the distance travelled, trigonometry. The road is seeded. The
  forecast adds up quantities so that it needs every cell; it is not a quantity that anybody would ask for.
"""

from __future__ import annotations

import random
import sys
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

__all__ = ["BOOKS", "CASE_STUDY", "CELLS_A_STEP", "write_march", "write_skid"]

CASE_STUDY = Path(__file__).resolve().parents[1] / "examples" / "intersection.xlsx"
G = 32.174
CELLS_A_STEP = 20
SECONDS = 3.0
ROAD_ROWS = 41

Row = tuple[str, str, float, float, float]
"""Name as a person reads it, defined name, value, low, high."""

SKID: tuple[Row, ...] = (
    ("Friction", "friction", 0.75, 0.65, 0.85),
    ("Distance, ft", "distance", 100, 97, 103),
    ("Grade, %", "grade", 2, 1, 3),
)

MARCH: tuple[Row, ...] = (
    ("Initial speed, ft/s", "speed_0", 75, 68, 82),
    ("Friction", "friction", 0.72, 0.6, 0.84),
    ("Reaction time, s", "reaction", 0.5, 0.3, 0.7),
    ("Brake rise time, s", "rise", 0.25, 0.15, 0.35),
    ("Fade speed, ft/s", "fade_speed", 55, 50, 60),
    ("Fade, 1/(ft/s)", "fade", 0.004, 0.002, 0.006),
    ("Steer angle, rad", "steer", 0.02, 0.01, 0.03),
    ("Steer decay, s", "decay", 1.5, 1, 2),
    ("Wheelbase, ft", "wheelbase", 9.2, 9, 9.4),
    ("Understeer, (s/ft)^2", "understeer", 0.0003, 0.0002, 0.0004),
    ("Weight, lb", "weight", 3500, 3400, 3600),
    ("Initial heading, rad", "heading_0", 0.1, 0.05, 0.15),
)


def write_skid(path: Path) -> None:
    """V = sqrt(2 g d (f cos θ + sin θ)), the speed that a skid of length d up a grade θ ends, in mph."""
    from xlsxwriter import Workbook

    with Workbook(path) as book:
        _inputs(book, SKID)
        model = book.add_worksheet("Model")
        formulas = (
            ("Slope, rad", "=ATAN(grade/100)"),
            ("Drag", "=friction*COS(B1)+SIN(B1)"),
            ("Speed, ft/s", f"=SQRT(2*{G}*distance*B2)"),
            ("Speed, mph", "=B3*3600/5280"),
        )
        for row, (label, formula) in enumerate(formulas):
            model.write_string(row, 0, label)
            model.write_formula(row, 1, formula)
        _forecast(book, "Speed, mph", "=Model!B4")


def write_march(path: Path, cells: int, seed: int = 2001) -> None:
    """`cells` formula cells, CELLS_A_STEP to a time step; time steps divide SECONDS."""
    from xlsxwriter import Workbook

    steps = cells // CELLS_A_STEP
    with Workbook(path) as book:
        _inputs(book, MARCH)
        _road(book, seed)
        model = book.add_worksheet("Model")
        model.write_row(0, 0, COLUMNS)
        for column, start in enumerate(START):
            write = model.write_formula if isinstance(start, str) else model.write_number
            write(1, column, start)
        for row in range(3, steps + 3):
            for column, formula in enumerate(_step(row, SECONDS / steps)):
                model.write_formula(row - 1, column, formula)
        last = steps + 2
        total = f"=SUM(Model!S3:S{last})/weight+Model!T{last}/weight+SQRT(Model!M{last}^2+Model!N{last}^2)"
        _forecast(book, "All steps", total)


COLUMNS = (
    *("time", "grade", "slope", "friction here", "fade", "braking", "drag", "acceleration", "speed", "distance"),
    *("yaw rate", "heading", "x", "y", "lateral", "demand", "mean demand", "sliding", "energy", "work"),
)
START = (0, 0, 0, 0, 0, 0, 0, 0, "=speed_0", 0, 0, "=heading_0", 0, 0, 0, 0, 0, 0, 0, 0)
"""The row before the first step."""


def _step(r: int, dt: float) -> Iterator[str]:
    """The formulas of the step in row `r`, in the order of COLUMNS."""
    p, first = r - 1, max(3, r - 4)
    yield f"=A{p}+{dt!r}"
    yield f"=VLOOKUP(J{p},Road!$A$2:$C${ROAD_ROWS + 1},2,TRUE)/100"
    yield f"=ATAN(B{r})"
    yield f"=friction*INDEX(Road!$C$2:$C${ROAD_ROWS + 1},MATCH(J{p},Road!$A$2:$A${ROAD_ROWS + 1},1))"
    yield f"=IF(I{p}>fade_speed,1-fade*(I{p}-fade_speed),1)"
    yield f"=MIN(1,MAX(0,(A{r}-reaction)/rise))"
    yield f"=F{r}*D{r}*E{r}*COS(C{r})+SIN(C{r})"
    yield f"=-{G}*G{r}"
    yield f"=MAX(0.1,I{p}+H{r}*{dt!r})"
    yield f"=J{p}+(I{r}+I{p})/2*{dt!r}"
    yield f"=steer*I{r}/(wheelbase*(1+understeer*I{r}^2))*EXP(-A{r}/decay)"
    yield f"=L{p}+K{r}*{dt!r}"
    yield f"=M{p}+I{r}*COS(L{r})*{dt!r}"
    yield f"=N{p}+I{r}*SIN(L{r})*{dt!r}"
    yield f"=I{r}*K{r}/{G}"
    yield f"=SQRT(G{r}^2+O{r}^2)"
    yield f"=SUM(P{first}:P{r})/{r - first + 1}"
    yield f"=IF(Q{r}>D{r}*E{r},Q{r}-D{r}*E{r},0)"
    yield f"=weight/{G}/2*(I{p}^2-I{r}^2)"
    yield f"=T{p}+S{r}+R{r}*weight*(J{r}-J{p})"


def _road(book: Any, seed: int) -> None:
    """Grade in percent and a factor of the friction, every 10 ft."""
    rng = random.Random(seed)
    sheet = book.add_worksheet("Road")
    sheet.write_row(0, 0, ("from, ft", "grade, %", "factor"))
    grade = 0.0
    for row in range(ROAD_ROWS):
        grade = min(4.0, max(-4.0, grade + rng.uniform(-1, 1)))
        sheet.write_row(row + 1, 0, (10 * row, round(grade, 2), round(rng.uniform(0.85, 1.1), 3)))


def _inputs(book: Any, rows: Sequence[Row]) -> None:
    sheet = book.add_worksheet("Inputs")
    columns = [{"header": heading} for heading in ("Name", "Value", "Low", "High")]
    data = [[name, value, low, high] for name, _, value, low, high in rows]
    sheet.add_table(0, 0, len(rows), 3, {"name": "xlmc_assumptions", "columns": columns, "data": data})
    for row, (_, symbol, *_) in enumerate(rows):
        book.define_name(symbol, f"=Inputs!$B${row + 2}")


def _forecast(book: Any, name: str, formula: str) -> None:
    sheet = book.add_worksheet("Answer")
    columns = [{"header": "Name"}, {"header": "Value"}]
    sheet.add_table(0, 0, 1, 1, {"name": "xlmc_forecasts", "columns": columns, "data": [[name, 0]]})
    sheet.write_formula(1, 1, formula)


BOOKS: dict[str, Callable[[Path], None] | None] = {
    "case-study": None,
    "skid": write_skid,
    "cells-1000": lambda path: write_march(path, 1_000),
    "cells-20000": lambda path: write_march(path, 20_000),
}
"""Name of a book -> what writes it; None for the committed case study."""


def make_books(folder: Path, names: Sequence[str] = tuple(BOOKS)) -> dict[str, Path]:
    """Write the books asked for into `folder`: name -> path."""
    paths = {}
    for name in names:
        write = BOOKS[name]
        if write is None:
            paths[name] = CASE_STUDY
        else:
            paths[name] = folder / f"{name}.xlsx"
            write(paths[name])
    return paths


if __name__ == "__main__":
    for path in make_books(Path(sys.argv[1])).values():
        print(path)
