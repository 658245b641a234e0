"""The fused engine: one compiled loop over the trials instead of one NumPy call a node. Optional: it needs llvmlite.

The loop is LLVM code that is built instruction by instruction from the graph's nodes: no source text, no names of the
workbook's. `operations` says which nodes it can compute; the others are left to the functions' own bodies, block by
block, between two loops (`phase`). A trial in which anything may be an error is computed again on the careful path.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any, Final

from xlmc.errors import SimulationError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from xlmc.engine.engine import Program, Target
    from xlmc.engine.graph.lowering import Lowering

__all__ = ["REPAYS_FROM", "available", "jit_filler", "jit_program"]

REPAYS_FROM: Final = 3_000_000
"""Trials of a model of some dozens of formulas from which the time to compile it, some 0.45 s, is surely repaid."""


def available() -> bool:
    """Whether llvmlite is installed."""
    return find_spec("llvmlite") is not None


def jit_program(
    lowering: Lowering,
    filters: Sequence[Target],
    forecasts: Sequence[Target],
    may_err: frozenset[str],
) -> Program:
    """Make a program of compiled loops, or that of the engine `numpy` where it is quicker.

    Args:
        lowering: the graph of nodes.
        filters: evaluated on all trials.
        forecasts: evaluated on the survivors.
        may_err: the inputs whose draws may be errors (NaNs).

    Raises:
        SimulationError: llvmlite is not installed.
    """
    if not available():
        hint = 'install it with `pip install "llvmlite>=0.45"`, or use the engine `numpy`'
        raise SimulationError("the engine `jit` needs the package llvmlite, which is not installed", hint=hint)
    from xlmc.engine.llvm.program import fastest_program

    return fastest_program(lowering, filters, forecasts, may_err)


def jit_filler(
    streams: Sequence[Any], maps: Sequence[tuple[float, float]], rows: NDArray[np.float64]
) -> Callable[[int], None]:
    """See `uniforms.filler`; llvmlite must be installed."""
    from xlmc.engine.llvm.uniforms import filler

    return filler(streams, maps, rows)
