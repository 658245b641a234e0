"""Random books whose formulas are functions of numbers that a lookup finds in a table."""

from __future__ import annotations

import random

TRIALS = 3_000
GIVEN = {"a": {"cell": "A1", "low": 0, "high": 10}, "b": {"cell": "A2", "low": -1, "high": 3}}
TABLE = {f"{column}{row}": number for row in range(1, 10) for column, number in (
    ("K", row - 1.0),
    ("L", 10.0 - row),
    ("M", (row**2) / 3 - 7.1),
    ("N", row * 0.37),
    ("O", [-0.5, 3.0, 0.0, 0.25, 1.0, 9.0, -2.0, 0.5, 0.125][row - 1]),
    ("P", 10.0 ** (40 * (row - 5))),
)}  # fmt: skip
CELLS = {"A1": 1.0, "A2": 1.0, **TABLE}
LOOKUPS = (
    "VLOOKUP({k},$K$1:$P$9,{c},TRUE)",
    "INDEX({v},MATCH({k},$K$1:$K$9,1))",
    "INDEX({v},MATCH({k},$L$1:$L$9,-1))",
    "LOOKUP({k},$K$1:$K$9,{v})",
    "VLOOKUP(ROUND({k},0),$K$1:$P$9,{c},FALSE)",
    "INDEX({v},MATCH({k},{{0;1;1.5;4;5;5.1;6;7;8}},1))",
)
OUTER = (
    *("SIN({x})", "COS({x})", "ATAN({x}/100)", "EXP({x})", "LN({x})", "SQRT({x})", "TAN({x})", "{x}^1.7", "2^{x}"),
    *(
        "COS(ATAN({x}/100))",
        "SIN(ATAN({x}/100))",
        "LN(COS({x}))",
        "ATAN(1/{x})",
        "EXP(-{x}*{x}/2)",
        "{x}^-2",
        "ASIN({x})",
    ),
    *("1/(1+EXP({x}))", "SINH({x})", "LOG10({x}+8)", "EXP({x})*A2", "ATAN({x}+A2)", "EXP(({x}-1)*0.5+2)", "1-EXP({x})"),
)
AROUND = (
    *("{y}", "{y}+{z}", "IF(A2>0.5,{y},{z})", "IFERROR({y},A2)", "SUM({y},{z},1)", "IF(A1>5,{y},0)*SIN({z})"),
    *("IF(A1>9,1/(A2-0.4),{y})", "MAX({y},{z})", "{y}-{y}*A2", "IF({y}>{z},1,2)"),
)


def some_formula(of):
    def looked_up():
        column = of.choice("KLMNOP")
        key = of.choice(("A1", "A1*0.5", "ABS(A2)*3", "A1-0.5" if of.random() < 0.2 else "A1/2"))
        of_table = of.choice(LOOKUPS).format(k=key, c="KLMNOP".index(column) + 1, v=f"${column}$1:${column}$9")
        return of.choice(OUTER).format(x=of_table)

    return "=" + of.choice(AROUND).format(y=looked_up(), z=looked_up())


def some_book(book, number):
    of = random.Random(number)
    cells = CELLS | {f"B{row}": some_formula(of) for row in range(1, 7)}
    cells |= {"C1": f"={of.choice(('B1', 'B2', 'A1'))}<{of.choice((0.5, 3, 9))}", "C2": "=A1>11"}
    filters = of.choice(({}, {}, {"f": "C1"}, {"f": "C1", "g": {"cell": "B3", "at_least": 0}}, {"none": "C2"}))
    return book(cells, GIVEN, {f"f{row}": f"B{row}" for row in range(1, 7)}, filters)


def outcome_of(run):
    columns = {**run.inputs, **run.forecasts}
    arrays = [run.trial_index.tobytes(), *(values.tobytes() for values in columns.values())]
    return arrays, run.faults, run.tally.rejected.tolist(), run.error_trials, run.block
