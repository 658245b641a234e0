from __future__ import annotations

from random import Random

import numpy as np
import pytest
from hypothesis import event, given, note, settings
from hypothesis import strategies as st

INPUTS = ("A1", "A2", "A3")
HELD = {"B1": 2.0, "B2": "x", "B4": True, "B5": "2", "B6": -0.5}  # B3 is blank
RANGES = ("A1:A3", "B1:B3", "B4:B6", "A1:B2", "B3:B3")
NUMBERS = ("0", "1", "2", "0.5", "3", "1E3", "10%")

PAIRS = ("+", "-", "*", "/", "^", "=", "<>", "<", "<=", ">", ">=", "&")
ONE = ("SQRT", "LN", "EXP", "ABS", "SIN", "INT", "SIGN", "NOT", "ISERROR", "ISNUMBER", "TAN", "ASIN")
TWO = ("IFERROR", "IFNA", "AND", "OR", "XOR", "MOD", "POWER", "ATAN2", "ROUND", "MAX", "IF")
MANY = ("SUM", "MIN", "MAX", "PRODUCT", "AVERAGE", "COUNT", "AND", "OR", "COUNTA")
ARRAYS = ("SUM({{1,2,3}}*{0})", "SUMPRODUCT(({1}>{0})*{1})", "SUM(LARGE({1},{{1,2}}))", "({0}+{{1;2}})", "MEDIAN({1})")


def expression(random, cells, depth):
    """A formula over the inputs, cells that hold all kinds of values, and the formula cells so far."""
    if random.random() < 0.25 or depth == 0:
        return random.choice((*INPUTS, *INPUTS, *HELD, "B3", *NUMBERS, *cells, *cells))

    def part():
        return expression(random, cells, depth - 1)

    ranges = (*RANGES, *([f"C1:C{len(cells)}"] if cells else []))
    return random.choice(
        (
            lambda: f"({part()}{random.choice(PAIRS[:4])}{part()})",
            lambda: f"({part()}{random.choice(PAIRS)}{part()})",
            lambda: f"({random.choice('-+')}{part()})",
            lambda: f"{random.choice(ONE)}({part()})",
            lambda: f"{random.choice(TWO)}({part()},{part()})",
            lambda: f"IF({part()},{part()},{part()})",
            lambda: f"IF({part()}>{part()},{part()},SQRT(A1-{random.random()}))",
            lambda: f"{random.choice(MANY)}({random.choice(ranges)},{part()})",
            lambda: f"{random.choice(MANY)}({random.choice(ranges)})",
            lambda: random.choice(ARRAYS).format(part(), random.choice(ranges)),
        )
    )()


def a_book(seed):
    """Cells that build on each other, one or two filters, forecasts, and draws, harmless ones or any."""
    random = Random(seed)
    cells, names = dict(HELD), []
    for row in range(1, random.randint(2, 7)):
        cells[f"C{row}"] = "=" + expression(random, names, 3)
        names.append(f"C{row}")
    filters = [f"D{row}" for row in range(1, random.randint(1, 3))]
    for name in filters:
        cells[name] = f"={random.choice(names)}>{random.choice(('0', '0.7', 'A1'))}"
    forecasts = random.sample((*names, *INPUTS), random.randint(1, 4))
    odd = random.choice(((), (0.0, 1.0, -1.0, 2.0, 1e200, -3.5), (1.0, 2.0, 0.75)))
    numbers = [*odd, *(random.uniform(0.1, 2.0) for _ in range(10))]
    return cells, {name: random.choices(numbers, k=20) for name in INPUTS}, forecasts, filters


@settings(max_examples=60000, deadline=None)
@given(st.integers(0, 2**40))
def test_the_fast_path_equals_the_careful_one(run, seed):
    case = a_book(seed)
    note(case)
    event(f"careful: {run(*case).careful}")
