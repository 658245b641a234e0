"""The workbooks that the contestants are measured on: `python benchmarks/books.py FOLDER` writes those that it makes.

- `case-study`: examples/intersection.xlsx, 17 assumptions, 42 needed formula cells, 3 filters, 4 forecasts.
- `skid`: a speed from a skid mark on a grade, 3 assumptions, 4 formula cells, 1 forecast.
- `cells-1000` and `cells-20000`: a vehicle brakes and steers over an uneven road, 20 formula cells a time step, 50 and
  1,000 steps: arithmetic, IF, SUM over ranges, lookups by the distance travelled, trigonometry. The road is seeded. The
  forecast adds up quantities so that it needs every cell; it is not a quantity that anybody would ask for.
- `powers`: POWER, EXP and LN as engineers write them: creep, wind and drag, heat, reliability, lognormal algebra,
  fatigue, blast; 24 assumptions, 50 formula cells, 8 forecasts.
- `wide`: 1,000 assumptions and 200 forecasts; each forecast adds up five assumptions' terms and takes another's root.
"""

from __future__ import annotations

import random
import sys
from collections.abc import Callable, Iterator, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any

__all__ = [
    *("BOOKS", "CASE_STUDY", "CELLS_A_STEP", "POWERS", "make_books", "march_cells", "road", "term_rows", "wide_inputs"),
    *("write_kind", "write_march", "write_powers", "write_skid", "write_wide"),
]

CASE_STUDY = Path(__file__).resolve().parents[1] / "examples" / "intersection.xlsx"
G = 32.174
CELLS_A_STEP = 20
SECONDS = 3.0
ROAD_ROWS = 41
ROAD_STEP = 10
ROAD_SEED = 2001

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


POWERS: tuple[Row, ...] = (
    ("Metal temperature, K", "metal", 900, 880, 920),
    ("Stress, MPa", "stress", 120, 100, 140),
    ("Creep exponent", "creep_n", 4.5, 4.2, 4.8),
    ("Activation energy, J/mol", "activation", 250000, 240000, 260000),
    ("Hours", "hours", 1000, 800, 1200),
    ("Larson-Miller limit", "limit", 22, 21.5, 22.5),
    ("Air temperature, K", "air", 290, 280, 300),
    ("Air pressure, Pa", "pressure", 100000, 98000, 102000),
    ("Wind at 10 m, m/s", "wind", 12, 8, 16),
    ("Roughness, m", "roughness", 0.03, 0.01, 0.05),
    ("Wind exponent", "shear", 0.16, 0.14, 0.18),
    ("Height, m", "height", 25, 15, 35),
    ("Diameter, m", "diameter", 0.3, 0.25, 0.35),
    ("Prandtl number", "prandtl", 0.71, 0.7, 0.72),
    ("Repair cost, mean", "cost", 5000, 4000, 6000),
    ("Repair cost, standard deviation", "cost_sd", 1500, 1200, 1800),
    ("Weibull shape", "weibull_shape", 2.2, 1.8, 2.6),
    ("Weibull scale, h", "weibull_scale", 9000, 8000, 10000),
    ("Fatigue strength, MPa", "fatigue", 900, 850, 950),
    ("Basquin exponent", "basquin", -0.1, -0.12, -0.09),
    ("Charge, kg", "charge", 5, 3, 7),
    ("Distance of the charge, m", "far", 20, 15, 25),
    ("Strain", "strain", 0.2, 0.1, 0.3),
    ("Strain rate, 1/s", "strain_rate", 500, 100, 900),
)

POWER_CELLS: tuple[tuple[str, str], ...] = (
    ("Arrhenius factor", "=EXP(-activation/(8.314*metal))"),  # B1
    ("Creep rate, 1/h", "=1E-3*B1*(stress/10)^creep_n*1E9"),
    ("Primary creep", "=2E-5*(stress/100)^1.8*hours^(1/3)"),
    ("Creep strain", "=B2*hours+B3"),
    ("Larson-Miller parameter", "=metal*(20+LOG10(hours))/1000"),  # B5
    ("Rupture time, h", "=10^(1000*limit/metal-20)"),
    ("Life used", "=hours/B6+(B5/limit)^12"),
    ("Air density", "=pressure/(287.05*air)"),
    ("Viscosity", "=1.458E-6*air^1.5/(air+110.4)"),
    ("Wind, log law", "=wind*LN(height/roughness)/LN(10/roughness)"),  # B10
    ("Wind, power law", "=wind*(height/10)^shear"),
    ("Wind there", "=SQRT(B10*B11)"),
    ("Reynolds number", "=B8*B12*diameter/B9"),
    ("Drag coefficient", "=24/B13*(1+0.15*B13^0.687)+0.42/(1+42500*B13^-1.16)"),
    ("Drag, N/m", "=B8*B12^2/2*B14*diameter"),  # B15
    ("Nusselt number", "=0.3+0.62*B13^0.5*prandtl^(1/3)/(1+(0.4/prandtl)^(2/3))^0.25*(1+(B13/282000)^(5/8))^0.8"),
    ("Conductivity", "=0.0241*(air/273.15)^0.9"),
    ("Heat transfer, W/m2K", "=B16*B17/diameter"),
    ("Cooling, 1/s", "=B18*4/(7850*460*diameter)"),
    ("Temperature in an hour, K", "=air+(metal-air)*EXP(-B19*3600)"),  # B20
    ("Radiation, W/m2", "=0.8*5.67E-8*(B20^4-air^4)"),
    ("Variation squared", "=(cost_sd/cost)^2"),
    ("Sigma of the logarithm", "=SQRT(LN(1+B22))"),
    ("Mu of the logarithm", "=LN(cost)-B23^2/2"),
    ("Median cost", "=EXP(B24)"),  # B25
    ("Most likely cost", "=EXP(B24-B23^2)"),
    ("Cost, 95 %", "=EXP(B24+1.6448536*B23)"),
    ("Skewness of the cost", "=(EXP(B23^2)+2)*SQRT(EXP(B23^2)-1)"),
    ("Time over scale", "=hours*8/weibull_scale"),
    ("Reliability", "=EXP(-(B29^weibull_shape))"),  # B30
    ("Hazard, 1/h", "=weibull_shape/weibull_scale*POWER(B29,weibull_shape-1)"),
    ("Life of 90 %, h", "=weibull_scale*(-LN(0.9))^(1/weibull_shape)"),
    ("Median life, h", "=weibull_scale*LN(2)^(1/weibull_shape)"),
    ("Cost of failures", "=(1-B30)*B27+B31*B25*100+(B26+B33)/B32"),
    ("Cycles", "=POWER(stress*2/fatigue,1/basquin)"),  # B35
    ("Mean stress factor", "=(1-stress/(2*fatigue))^(-1/basquin)"),
    ("Cycles left", "=B35/B36"),
    ("Logarithm of the cycles", "=LOG10(B37)"),
    ("Damage of a year", "=1000/B37"),
    ("Damage, with cost", "=B39*B28+B38"),  # B40
    ("Scaled distance", "=far/charge^(1/3)"),
    ("Overpressure, kPa", "=100*(0.84/B41+2.7/B41^2+7/B41^3)"),
    ("Arrival, ms", "=charge^(1/3)*0.34*B41^1.4"),
    ("Duration, ms", "=charge^(1/6)*1.35*far^0.5"),
    ("Decay of the pressure", "=EXP(-B43/(B44+B43))"),  # B45
    ("Probit", "=-77.1+6.91*LN(B42*1000)"),
    ("Homologous temperature", "=(metal-298)/(1790-298)"),
    ("Flow stress, MPa", "=(350+275*strain^0.36)*(1+0.022*LN(strain_rate))*(1-B47^1.03)"),
    ("Work, MJ/m3", "=350*strain+275*strain^1.36/1.36+B48*0.01"),
    ("Blast index", "=B46*B45+LN(B42)"),  # B50
)
POWER_FORECASTS = (4, 7, 15, 21, 34, 40, 49, 50)
"""The rows of POWER_CELLS asked for; together they need all."""

WIDE_ASSUMPTIONS, WIDE_FORECASTS = 1_000, 200
WIDE_LOW, WIDE_HIGH = 0.5, 1.5
KIND: tuple[Row, ...] = (("First", "first", 1.0, 0.5, 1.5), ("Second", "second", 1.0, 0.5, 1.5))
"""The assumptions of a book of cells of one kind."""


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
        _forecasts(book, [("Speed, mph", "=Model!B4")])


def write_powers(path: Path) -> None:
    """POWER_CELLS, each label beside its formula."""
    from xlsxwriter import Workbook

    with Workbook(path) as book:
        _inputs(book, POWERS)
        model = book.add_worksheet("Model")
        for row, (label, formula) in enumerate(POWER_CELLS):
            model.write_string(row, 0, label)
            model.write_formula(row, 1, formula)
        _forecasts(book, [(POWER_CELLS[row - 1][0], f"=Model!B{row}") for row in POWER_FORECASTS])


def write_kind(path: Path, formula: str, cells: int) -> None:
    """So many cells of one formula, each over a number of its own in column A; the forecast is their sum.

    `{r}` in the formula is the row of a cell; `first` and `second` are the assumptions.
    """
    from xlsxwriter import Workbook

    with Workbook(path) as book:
        _inputs(book, KIND)
        model = book.add_worksheet("Model")
        for row in range(1, cells + 1):
            model.write_formula(row - 1, 0, f"=first*second+{row}/7")
            model.write_formula(row - 1, 2, "=" + formula.format(r=row))
        _forecasts(book, [("Sum", f"=SUM(Model!C1:C{cells})")])


def write_wide(path: Path, assumptions: int = WIDE_ASSUMPTIONS, forecasts: int = WIDE_FORECASTS) -> None:
    """A term t = x + x²/10 of every assumption x; a forecast is the sum of some terms and the root of another."""
    from xlsxwriter import Workbook

    with Workbook(path) as book:
        _inputs(book, wide_inputs(assumptions))
        model = book.add_worksheet("Model")
        for row in range(assumptions):
            model.write_formula(row, 0, f"=Inputs!B{row + 2}+Inputs!B{row + 2}^2/10")
        rows = term_rows(assumptions, forecasts)
        answers = (f"=SUM(Model!A{first + 1}:A{end})+SQRT(Model!A{other + 1})" for first, end, other in rows)
        _forecasts(book, [(f"Answer {k}", formula) for k, formula in enumerate(answers, start=1)])


def wide_inputs(assumptions: int = WIDE_ASSUMPTIONS) -> tuple[Row, ...]:
    """The assumptions of a wide book."""
    return tuple((f"Input {k}", f"input_{k}", 1.0, WIDE_LOW, WIDE_HIGH) for k in range(1, assumptions + 1))


def term_rows(assumptions: int, forecasts: int) -> list[tuple[int, int, int]]:
    """For every forecast of a wide book the first term of its sum, the one after the last, and the term of its root."""
    starts = [k * assumptions // forecasts for k in range(forecasts + 1)]
    rows = pairwise(starts)
    return [(first, max(first + 1, end), 7 * k % assumptions) for k, (first, end) in enumerate(rows)]


def write_march(path: Path, cells: int, seed: int = ROAD_SEED) -> None:
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
        _forecasts(book, [("All steps", total)])


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


def road(seed: int = ROAD_SEED) -> list[tuple[float, float, float]]:
    """Where a row begins in ft, grade in percent and a factor of the friction, every ROAD_STEP ft, seeded."""
    rng = random.Random(seed)
    rows = []
    grade = 0.0
    for row in range(ROAD_ROWS):
        grade = min(4.0, max(-4.0, grade + rng.uniform(-1, 1)))
        rows.append((ROAD_STEP * row, round(grade, 2), round(rng.uniform(0.85, 1.1), 3)))
    return rows


def _road(book: Any, seed: int) -> None:
    sheet = book.add_worksheet("Road")
    sheet.write_row(0, 0, ("from, ft", "grade, %", "factor"))
    for row, numbers in enumerate(road(seed), start=1):
        sheet.write_row(row, 0, numbers)


def _inputs(book: Any, rows: Sequence[Row]) -> None:
    sheet = book.add_worksheet("Inputs")
    columns = [{"header": heading} for heading in ("Name", "Value", "Low", "High")]
    data = [[name, value, low, high] for name, _, value, low, high in rows]
    sheet.add_table(0, 0, len(rows), 3, {"name": "xlmc_assumptions", "columns": columns, "data": data})
    for row, (_, symbol, *_) in enumerate(rows):
        book.define_name(symbol, f"=Inputs!$B${row + 2}")


def _forecasts(book: Any, asked: Sequence[tuple[str, str]]) -> None:
    sheet = book.add_worksheet("Answer")
    columns = [{"header": "Name"}, {"header": "Value"}]
    data = [[name, 0] for name, _ in asked]
    sheet.add_table(0, 0, len(asked), 1, {"name": "xlmc_forecasts", "columns": columns, "data": data})
    for row, (_, formula) in enumerate(asked, start=1):
        sheet.write_formula(row, 1, formula)


BOOKS: dict[str, Callable[[Path], None] | None] = {
    "case-study": None,
    "skid": write_skid,
    "cells-1000": lambda path: write_march(path, 1_000),
    "cells-20000": lambda path: write_march(path, 20_000),
    "powers": write_powers,
    "wide": write_wide,
}
"""Name of a book -> what writes it; None for the committed case study."""


def march_cells(book: str) -> int | None:
    """The formula cells of a book's time steps; None where it has none."""
    kind, _, cells = book.partition("-")
    return int(cells) if kind == "cells" else None


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
