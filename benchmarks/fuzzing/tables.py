"""Tables of definitions with values that do not belong there: texts, errors, extremes, formulas of themselves."""

from __future__ import annotations

import random
from pathlib import Path
from typing import Final

from fuzzing import grammar, hostile
from fuzzing.books import Sheet, Table, book, cell
from fuzzing.commands import commanded
from fuzzing.inputs import Input, Reached, steps_of
from fuzzing.outputs import examined
from xlmc.montecarlo.definitions.run_options import RunOptions
from xlmc.montecarlo.distributions import FAMILIES
from xlmc.montecarlo.model.loading import load
from xlmc.montecarlo.simulation.simulate import run_model

__all__ = ["make", "run"]

TRIALS: Final = 64
_STEPS: Final = {"summary": 0.4, "write": 0.015, "jit": 0.01, "check": 0.1, "simulate": 0.02}
_GOOD: Final = (
    {"Low": 1.0, "High": 3.0},
    {"Distribution": "Triangular", "Low": 1.0, "Likeliest": 2.0, "High": 3.0},
    {"Distribution": "Normal", "Mean": 2.0, "Std dev": 0.5},
    {"Distribution": "Normal", "P10": 1.0, "P90": 3.0},
    {"Distribution": "Lognormal", "Mean": 2.0, "Std dev": 0.5, "Lower cutoff": 0.5},
    {"Distribution": "Custom", "Data": "=Main!$D$1:$D$6"},
    {"Distribution": "Discrete", "Data": "=Main!$D$1:$E$6"},
    {"Distribution": "Poisson", "Rate": 3.0},
    {"Distribution": "Binomial", "Trials": 10.0, "Probability": 0.3},
    {"Distribution": "Weibull", "Location": 0.0, "Scale": 1.0, "Shape": 2.0},
)
_HEADINGS: Final = {
    "xlmc_assumptions": [
        "Name", "Cell", "Distribution", "Low", "High", "Likeliest", "Mean", "Std dev", "Location", "Scale", "Shape",
        "Rate", "Alpha", "Beta", "Probability", "Trials", "Degrees of freedom", "P10", "P50", "P90", "Lower cutoff",
        "Upper cutoff", "Data", "Units", "Source", "Frozen", "Value",
    ],
    "xlmc_forecasts": ["Name", "Cell", "Units", "Range %", "Threshold"],
    "xlmc_filters": ["Name", "Cell", "At least", "At most", "Above", "Below", "Because"],
    "xlmc_correlations": ["First", "Second", "Correlation"],
    "xlmc_settings": ["Setting", "Value"],
    "xlmc_checks": ["Name", "Cell", "Because"],
}  # fmt: skip
_SETTINGS: Final = (
    ("Trials", (100.0, 1.0, 0.0, 1e9, "1e3")), ("Seed", (7.0, -1.0, 0.5, 1e15)),
    ("Sampling", ("mc", "lhs", "sobol", "lhs500")),
    ("Range %", (90.0, 0.0, 100.0, 101.0, 0.5)), ("Engine", ("numpy", "formulas", "x")), ("Lognorm", ("XLRisk",)),
    ("Arithmetic", ("float64",)), ("Until accepted", (2.0, 50.0)), ("Precision %", (50.0, 1e-9)),
    ("Significant digits", (1.0, 15.0)), ("Confidence", (95.0, 0.0)), ("Time limit", ("1s", 1.0, "0s")),
    ("Precision of", ("mean", "p50", "p101")), ("Correlation repair", ("yes",)),
)  # fmt: skip
_EXTREME: Final = (0.0, -1.0, 1e-308, 5e-324, 1e308, -1e308, 1e-12, 1e12, 0.01, 1e6, 1 + 2**-52, 0.999999, 2.0, 100.0)
_CELLS: Final = (
    "=Main!A1", "=Main!A2", "=Main!A3", "=Main!A4", "=Main!B1", "=Main!B2", "=Main!B3", "Main!A1", "rate", "nope",
    "=Main!A1+1", "=Nowhere!A1", "A1", "=Main!A1:A3", "=A1", "Main!XFE1", "=Main!F1", "=#REF!", 5.0, True, "",
    "=[1]S!A1", "'Main'!a2", "=rate", "=INDIRECT(\"Main!A1\")", "=Main!1:1", "=Main!Z99",
)  # fmt: skip

_Grid = dict[str, list[dict[str, object]]]


def make(rng: random.Random) -> Input:
    """Tables of some sense, of which some values were changed."""
    rows = _sensible(rng)
    message = [_change(rng, rows) for _ in range(rng.choice([0, 0, 0, 1, 1, 1, 1, 2, 2, 3, 5]))]
    return Input("fuzz.xlsx", _book(rng, rows), "; ".join(message), steps_of(rng, _STEPS))


def run(given: Input, folder: Path) -> Reached:
    """Load the book and run it.

    Steps: `summary` makes the table for people; `write` writes its results and examines them; `jit` runs it with the
    other engine too; `check` and `simulate` give it to the command line, and to nothing else.

    Raises:
        XlmcError: as xlmc does.
    """
    path = folder / given.name
    path.write_bytes(given.data)
    if {"check", "simulate"} & {*given.steps}:
        return commanded(path, given.steps)
    model = load(path)
    result = run_model(model, RunOptions.of(trials=TRIALS))
    examined(result, folder, given.steps)
    if "jit" in given.steps:
        run_model(model, RunOptions.of(trials=TRIALS, engine="jit"))
    return Reached.RAN


def _sensible(rng: random.Random) -> _Grid:
    """Rows without a mistake, or nearly so."""
    good = rng.sample(_GOOD, 3)
    assumptions: list[dict[str, object]] = [
        {"Name": f"a{n}", "Cell": f"=Main!A{n}", "Units": "mph", **each} for n, each in enumerate(good, 1)
    ]
    if rng.random() < 0.3:
        assumptions[-1] = {"Name": "a3", "Cell": "=Main!A3", **_of_family(rng)}
    made: _Grid = {
        "xlmc_assumptions": assumptions,
        "xlmc_forecasts": [{"Name": "y", "Cell": "=Main!B1", "Threshold": 2.0}, {"Name": "z", "Cell": "=Main!B2"}],
    }
    if rng.random() < 0.5:
        made["xlmc_filters"] = [{"Name": "f", "Cell": "=Main!B3", "At least": 0.5, "Because": "engaged"}]
    if rng.random() < 0.4:
        made["xlmc_correlations"] = [
            {"First": "a1", "Second": "a2", "Correlation": rng.choice([0.5, -1.0, 1.0, 0.999])},
            {"First": "a2", "Second": "a3", "Correlation": rng.choice([0.5, -1.0, 1.0, 0.0])},
        ]
    if rng.random() < 0.4:
        picked = rng.sample(_SETTINGS, rng.randint(1, 4))
        made["xlmc_settings"] = [{"Setting": name, "Value": rng.choice(values)} for name, values in picked]
    if rng.random() < 0.1:
        made["xlmc_checks"] = [{"Name": "c", "Cell": "=Main!C1", "Because": "physics"}]
    return made


def _of_family(rng: random.Random) -> dict[str, object]:
    """Any family, with parameters that may be anything."""
    family = FAMILIES[rng.choice(sorted(FAMILIES))]
    row: dict[str, object] = {"Distribution": family.name}
    for parameter in family.parameters:
        common = rng.choice([0.5, 1.0, 2.0, 3.0, 10.0]) if rng.random() < 0.6 else rng.choice(_EXTREME)
        row[parameter.heading] = common
    if family.data is not None:
        row["Data"] = rng.choice(["=Main!$D$1:$D$6", "=Main!$D$1:$E$6", "=Main!$E$1:$E$6"])
    for cutoff in ("Lower cutoff", "Upper cutoff"):
        if rng.random() < 0.15:
            row[cutoff] = rng.choice(_EXTREME)
    return row


def _change(rng: random.Random, rows: _Grid) -> str:
    """Change one thing, and say what."""
    table = rng.choice([*rows, "xlmc_assumptions"])
    kind = rng.random()
    if not rows[table]:
        rows[table].append({})
    row = rng.choice(rows[table])
    known = _HEADINGS.get(table, _HEADINGS["xlmc_forecasts"])
    if kind < 0.6:
        heading = rng.choice([*row, *row, rng.choice(known)]) if row else rng.choice(known)
        row[heading] = _value(rng, heading)
        return f"{table}: {heading} {str(row[heading])[:80]!r}"
    if kind < 0.7:
        rows[table].append(dict(row))
        return f"{table}: a row twice"
    if kind < 0.78:
        rows[table].append({heading: _value(rng, heading) for heading in known if rng.random() < 0.3})
        return f"{table}: a row of chance"
    if kind < 0.86:
        rows[table] = [_of_family(rng) | {"Name": "x", "Cell": "=Main!A4"}, *rows[table]]
        return f"{table}: a family of chance"
    if kind < 0.9 and row:
        old = rng.choice(list(row))
        for each in rows[table]:
            if old in each:
                each[rng.choice([hostile.text(rng)[:300] or "x", old.upper() + " ", *known])] = each.pop(old)
        return f"{table}: the heading {old} renamed"
    if kind < 0.95:
        row.clear()
        return f"{table}: a blank row"
    rows[rng.choice(["xlmc_assumptions3", "xlmc_forecasts2", "XLMC_FILTERS", "xlmc_", "xlmc_oops", table + "_1"])] = [
        dict(row)
    ]
    return f"another table of {table}"


def _value(rng: random.Random, heading: str) -> object:
    """What a cell of the table holds."""
    kind = rng.random()
    if heading in ("Cell", "Data") and kind < 0.7:
        return rng.choice(_CELLS)
    if heading in ("Name", "First", "Second") and kind < 0.5:
        return rng.choice(["a1", "A1 ", "a2", "a3", "y", hostile.text(rng)])
    if heading == "Distribution" and kind < 0.5:
        return rng.choice([*sorted(FAMILIES), "Unifrom", "normal ", "PERT", "beta pert"])
    if kind < 0.35:
        return rng.choice(_EXTREME)
    if kind < 0.5:
        return hostile.text(rng)
    if kind < 0.6:
        return rng.choice(hostile.ERRORS)
    if kind < 0.65:
        return rng.choice([True, False, None])
    if kind < 0.75:
        return "=" + rng.choice(
            ["Main!A1", "Main!A1*0.9", "Main!B1", "T!D2", "T!A2", "RAND()", "1/0", "NA()", "Main!A3+T!E2"]
        )
    if kind < 0.82:
        return "=" + grammar.formula(rng, 1)
    return 10.0 ** rng.uniform(-3, 3) * rng.choice([1, 1, 1, -1])


def _book(rng: random.Random, tables: _Grid) -> bytes:
    """The workbook; the tables stand one below the other."""
    rows: dict[int, list[str]] = {}
    placed, top = [], 1
    for name, lines in tables.items():
        headings = list(dict.fromkeys(heading for line in lines for heading in line)) or ["Name"]
        if rng.random() < 0.3:
            rng.shuffle(headings)
        rows[top] = [cell(top, n, heading) for n, heading in enumerate(headings, 1)]
        for number, line in enumerate(lines, top + 1):
            rows[number] = [_cell(number, n, line.get(heading)) for n, heading in enumerate(headings, 1)]
        bottom = top + max(1, len(lines))
        placed.append(
            Table(name, f"A{top}:{chr(64 + len(headings)) if len(headings) <= 26 else 'AZ'}{bottom}", tuple(headings))
        )
        top = bottom + 2
        if rng.random() < 0.03:
            top = max(1, top - 3)  # the next one overlaps
    after = '<mergeCells count="1"><mergeCell ref="A2:B3"/></mergeCells>' if rng.random() < 0.02 else ""
    sheets = {"Main": Sheet(_main()), "T": Sheet(rows, tuple(placed), after)}
    return book(sheets, {"rate": "Main!$A$1", "a1": "Main!$A$1", "a4": "Main!$A$4"})


def _cell(row: int, column: int, value: object) -> str:
    if isinstance(value, str) and value.startswith("=") and len(value) > 1:
        return cell(row, column, None, value[1:])
    return cell(row, column, value)


def _main() -> dict[int, list[str]]:
    """The model: `A` assumptions, `B` forecasts and a filter, `C` a check, `D` and `E` data."""
    made = {
        1: [cell(1, 1, 2.0), cell(1, 2, 7, "A1*A2+A3"), cell(1, 3, True, "A1>0")],
        2: [cell(2, 1, 2.0), cell(2, 2, 2, "SQRT(A1)/A4"), cell(2, 3, False, "A1>2")],
        3: [cell(3, 1, 2.0), cell(3, 2, 1, "A1-A2+A4"), cell(3, 3, "x")],
        4: [cell(4, 1, 1.0), cell(4, 2, "text"), cell(4, 3)],
        5: [],
        6: [cell(6, 1, "#N/A")],
    }
    for row, number in enumerate((1.0, 2.0, 2.5, 3.0, 4.0, 9.0), 1):
        made[row] += [cell(row, 4, number), cell(row, 5, number / 10)]
    return made
