"""Functions that Microsoft describes as a formula of other functions, and that are computed as that formula."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING

from xlmc.evaluation.graph.scope import Scope
from xlmc.formula import ir

if TYPE_CHECKING:
    from xlmc.evaluation.graph.lower import Lowering

__all__ = ["WRITTEN_OUT"]

Arguments = tuple[ir.Expression, ...]


def _percent_of(lowering: Lowering, arguments: Arguments, scope: Scope) -> int:
    """PERCENTOF(subset, all) is SUM(subset)/SUM(all), says its page at Microsoft."""
    subset, everything = (ir.Call("SUM", (argument,)) for argument in arguments)
    return lowering.lower(ir.Binary("/", subset, everything), scope)


WRITTEN_OUT: Mapping[str, Callable[[Lowering, Arguments, Scope], int]] = {"PERCENTOF": _percent_of}
