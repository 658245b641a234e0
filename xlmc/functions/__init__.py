"""Excel's functions: `registry` holds one row each, the modules beside it one category each."""

from xlmc.functions import aggregate, arithmetic, logical, operators, rounding, trigonometry
from xlmc.functions.registry import REGISTRY, Function, Kind, function_named

__all__ = [
    "REGISTRY",
    "Function",
    "Kind",
    "aggregate",
    "arithmetic",
    "function_named",
    "logical",
    "operators",
    "rounding",
    "trigonometry",
]
