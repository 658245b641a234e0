"""Formulas: text → tree (`parse`) → tree of cells (`resolve`) → what the forecasts need (`graph`)."""

from xlmc.excel.formula import ir
from xlmc.excel.formula.graph import Filled, Graph, build_graph
from xlmc.excel.formula.ir import formula_text
from xlmc.excel.formula.parse import compile_with_formulas, parse
from xlmc.excel.formula.resolve import Resolver
from xlmc.excel.formula.stencil import Stencil

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
