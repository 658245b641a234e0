"""Formulas of shipped books, with parts of them put in the place of others."""

from __future__ import annotations

import random
import re
from functools import cache
from typing import Final

from fuzzing import grammar
from fuzzing.books import shipped
from xlmc.excel.workbook.reader import read_workbook

__all__ = ["spliced"]

_TOKEN: Final = re.compile(
    r"(?:'[^']+'|\w+)?!?\$?\b[A-Z]{1,3}\$?\d+\b(?:\$?\b[A-Z]{1,3}\$?\d+\b)?|\b\d+(?:\.\d+)?\b|\b[a-zA-Z_]\w+\b(?!\()"
)
_HOME: Final = ("A1", "A2", "A3", "A4", "A5", "B1", "C2", "D6", "B1:D6", "A1:A4")


@cache
def _formulas() -> tuple[str, ...]:
    """Every formula text of the shipped books."""
    result = set()
    for name, data in shipped():
        for sheet in read_workbook(data, name).sheets.values():
            result |= {cell.formula.text for cell in sheet.cells.values() if cell.formula is not None}
    return tuple(sorted(result))


def spliced(rng: random.Random) -> str:
    """A shipped formula whose references are those of the fuzzed book, with some parts replaced by others."""
    text = rng.choice(_formulas())[:2000]
    text = _TOKEN.sub(lambda result: _moved(rng, result[0]), text)
    for _ in range(rng.randint(0, 3)):
        text = _replaced(rng, text)
    return text


def _moved(rng: random.Random, token: str) -> str:
    """References and names become cells of the fuzzed book; most numbers stay."""
    if token[0].isdigit() or token in ("TRUE", "FALSE"):
        return token if rng.random() < 0.8 else grammar.formula(rng, 0)
    return rng.choice(_HOME)


def _replaced(rng: random.Random, text: str) -> str:
    """One part, in brackets or a token, replaced by a piece of the grammar, of another formula or of the same."""
    pieces = [result.span() for result in re.finditer(r"\([^()]*\)|[A-D]\d|\d+(?:\.\d+)?|[-+*/^<>=&,]", text)]
    if not pieces:
        return text
    start, end = rng.choice(pieces)
    other = rng.choice(pieces)
    if text[start:end] in "-+*/^<>=&,":
        return text[:start] + rng.choice(["-", "+", "*", "/", "^", "&", "=", "<>", ",", ":"]) + text[end:]
    piece = rng.choice([grammar.formula(rng, 1), text[slice(*other)], rng.choice(_formulas())[:60]])
    return f"{text[:start]}({piece}){text[end:]}"
