"""What stands beside a cell as its equation is that equation: one symbol for one quantity, and the same value."""

from __future__ import annotations

import math
import re
from itertools import pairwise

import numpy as np
import pytest
from committed_books import BOOKS

from templates.description import Role
from templates.notation import printed

TEMPLATES = (
    "skid",
    "critical-speed-yaw",
    "collinear",
    "momentum",
    "planar-impact",
    "planar-forward",
    "crush-energy",
    "pedestrian-throw",
    "time-distance",
    "airborne",
    "edr-speed",
    "video-speed",
    "momentum-energy",
    "pedestrian",
    "low-speed",
    "motorcycle",
    "beam",
    "tolerance-stack",
    "mass-calibration",
    "project",
    "warranty",
)
EDITIONS = [name + units for name in TEMPLATES for units in ("", "-si") if name + units in BOOKS]
SIGNS = {
    "·": "*",
    "−": "-",
    "²": "**2",
    "≥": ">=",
    "≤": "<=",
    "≠": "!=",
    " = ": " == ",
    "√": "sqrt",
    "°": "",
    "^": "**",
}
"""How Python writes what mathematics writes."""
EPOCH = np.datetime64("1899-12-30")
"""Day 0 of a spreadsheet."""
CALLS = {"if": "either", "and": "every", "or": "some"}


def quantities(template):
    return [*template.inputs, *template.equations]


@pytest.mark.parametrize("name", EDITIONS)
def test_a_symbol_means_one_quantity(described, name):
    seen = {}
    for each in quantities(described[name]):
        assert not each.notation or seen.setdefault(each.notation, each.symbol) == each.symbol, each.notation


@pytest.mark.parametrize("name", EDITIONS)
def test_a_symbol_fits_its_column(described, opened, book_path, name):
    book = opened(book_path[name])
    for sheet, rows in (("Inputs", described[name].inputs), ("Model", described[name].equations)):
        assert max(len(each.notation) for each in rows) <= book[sheet].column_dimensions["B"].width


def test_every_template_is_read(builders):
    assert set(TEMPLATES) == set(builders["templates"].TEMPLATES)


class Blank(int):
    """What a blank cell is in an equation: 0, and yet no number."""


def whole(number):
    return math.floor(abs(number) + 0.5) * math.copysign(1, number)


def functions(degrees):
    """The functions of a printed equation; those of an angle take it in degrees, where they do."""
    turned = math.radians if degrees else float
    return {
        "sin": lambda x: math.sin(turned(x)),
        "cos": lambda x: math.cos(turned(x)),
        "tan": lambda x: math.tan(turned(x)),
        "rad": math.radians,
        "deg": math.degrees,
        "atan": math.atan,
        "atan2": math.atan2,
        "sqrt": math.sqrt,
        "abs": abs,
        "max": max,
        "min": min,
        "int": math.floor,
        "mod": lambda x, by: x - by * math.floor(x / by),
        "round": lambda x, _: whole(x),
        "exp": math.exp,
        "roundup": lambda x, _: math.ceil(x),
        "workday": lambda day, days: (np.busday_offset(EPOCH + int(day), int(days), roll="backward") - EPOCH).astype(
            int
        ),
        "sign": lambda x: (x > 0) - (x < 0),
        "either": lambda holds, then, otherwise: then() if holds else otherwise(),
        "choose": lambda which, *each: each[int(which) - 1],
        "every": lambda *each: all(each),
        "some": lambda *each: any(each),
        "isnumber": lambda x: not isinstance(x, Blank | str),
        "count": lambda *each: sum(not isinstance(x, Blank | str) for x in each),
        "true": True,
        "false": False,
    }


def branches(text):
    """The text with what `if` chooses from put off until it is chosen, as a spreadsheet does."""
    start = re.search(r"\beither\(", text)
    if start is None:
        return text
    depth, cuts = 0, [start.end() - 1]
    for place in range(start.end(), len(text)):
        depth += {"(": 1, ")": -1}.get(text[place], 0)
        if depth < 0 or (depth == 0 and text[place] == ","):
            cuts.append(place)
        if depth < 0:
            break
    first, *others = (text[a + 1 : b] for a, b in pairwise(cuts))
    chosen = ", ".join([branches(first), *(f"lambda: ({branches(each.strip())})" for each in others)])
    return f"{text[: start.end()]}{chosen}){branches(text[cuts[-1] + 1 :])}"


def as_python(equation, names):
    """A printed equation with the names of values in the place of its symbols, the longest first."""
    symbols = sorted(names, key=len, reverse=True)
    any_symbol = "|".join(rf"(?<![\w]){re.escape(symbol)}(?!(?!²)[\w′])" for symbol in symbols)
    text = re.sub(any_symbol, lambda result: names[result[0]], equation)
    for sign, message in SIGNS.items():
        text = text.replace(sign, message)
    for function, called in CALLS.items():
        text = re.sub(rf"\b{function}\(", f"{called}(", text)
    return branches(text)


@pytest.mark.parametrize("name", EDITIONS)
def test_a_printed_equation_computed_as_mathematics_gives_its_cell(described, shown, name):
    template = described[name]
    values = {symbol: Blank() if value is None else value for symbol, value in shown(name).items()}
    notation = {each.symbol: each.notation for each in quantities(template)}
    by_symbol = {symbol.lower(): symbol for symbol in values if not notation.get(symbol)}
    by_symbol |= {message: symbol for symbol, message in notation.items() if message}
    names = {printed_as: f"v[{symbol!r}]" for printed_as, symbol in by_symbol.items()}
    compared = 0
    for row in template.equations:
        if not isinstance(values[row.symbol], int | float) or row.role is Role.CHECK:
            continue
        if any(table.name in row.formula for table in template.data):
            continue
        # An angle is in degrees wherever Excel's formula has to turn it into radians.
        degrees = re.search(r"\b(SIN|COS|TAN)\((?!RADIANS)", row.formula) is None
        text = as_python(printed(row.formula, notation), names)
        result = eval(text, functions(degrees) | {"v": values})
        assert result == pytest.approx(values[row.symbol], rel=1e-9, abs=1e-9), (row.symbol, text)
        compared += 1
    assert compared > 4
