"""Formulas: text → tree (`parse`) → tree of cells (`resolve`) → what the forecasts need (`graph`)."""

from xlmc.formula import ir
from xlmc.formula.graph import Filled, Graph, build_graph
from xlmc.formula.ir import formula_text
from xlmc.formula.parse import compile_with_formulas, parse
from xlmc.formula.resolve import Resolver
from xlmc.formula.stencil import Stencil

__all__ = [
    "Filled",
    "Graph",
    "Resolver",
    "Stencil",
    "build_graph",
    "compile_with_formulas",
    "formula_text",
    "ir",
    "parse",
]
