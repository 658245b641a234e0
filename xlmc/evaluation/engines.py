"""The engines by name, and what each takes and brings."""

from collections.abc import Callable, Mapping
from typing import Any

from xlmc.errors import SimulationError
from xlmc.evaluation.engine import Program
from xlmc.evaluation.llvm import jit_filler, jit_program
from xlmc.evaluation.numpy.numpy_engine import NumpyProgram
from xlmc.evaluation.passes.bounds import Bounds
from xlmc.evaluation.reference.formulas_engine import FormulasProgram

__all__ = ["ENGINES", "FILLERS", "options_of"]

ENGINES: Mapping[str, Callable[..., Program]] = {
    "numpy": NumpyProgram.of,
    "jit": jit_program,
    "formulas": FormulasProgram,
}
"""Name of an engine -> program of (lowering, filters, forecasts, inputs whose draws may be errors)."""


def options_of(engine: str, arithmetic: str, between: Mapping[str, Bounds]) -> dict[str, Any]:
    """What a program of the engine takes besides.

    Args:
        engine: its name.
        arithmetic: `float64` or `float32`.
        between: name of an input -> its bounds, for engines that make use of them.

    Raises:
        SimulationError: there is no such arithmetic, or the engine does not know it.
    """
    if arithmetic == "float64":
        return {"between": between} if engine == "numpy" else {}
    if arithmetic != "float32":
        raise SimulationError(f"there is no arithmetic {arithmetic!r}", hint="choose float64 or float32")
    if engine != "jit":
        raise SimulationError(f"the engine `{engine}` computes in float64 only", hint="use `--engine jit`, or float64")
    return {"single": True}


FILLERS = {"jit": jit_filler}
"""Name of an engine -> what draws its uniforms, where it brings something of its own; see `sampling.draws.Filler`."""
