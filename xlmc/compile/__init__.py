"""Graph of formulas → one callable over blocks of trials, by the engine of one's choice."""

from collections.abc import Callable, Mapping

from xlmc.compile.engine import Column, Evaluator, Program, Target
from xlmc.compile.formulas_engine import FormulasProgram
from xlmc.compile.jit import jit_filler, jit_program
from xlmc.compile.lower import Lowering
from xlmc.compile.numpy_engine import NumpyProgram
from xlmc.compile.widening import widened
from xlmc.errors import SimulationError

__all__ = ["ENGINES", "FILLERS", "Column", "Evaluator", "Lowering", "Program", "Target", "options_of", "widened"]

ENGINES: Mapping[str, Callable[..., Program]] = {
    "numpy": NumpyProgram,
    "jit": jit_program,
    "formulas": FormulasProgram,
}
"""Name of an engine -> program of (lowering, filters, forecasts, inputs whose draws may be errors)."""


def options_of(engine: str, arithmetic: str) -> dict[str, bool]:
    """What a program of the engine takes besides, to compute in `float64` or `float32`.

    Raises:
        SimulationError: there is no such arithmetic, or the engine does not know it.
    """
    if arithmetic == "float64":
        return {}
    if arithmetic != "float32":
        raise SimulationError(f"there is no arithmetic {arithmetic!r}", hint="choose float64 or float32")
    if engine != "jit":
        raise SimulationError(f"the engine `{engine}` computes in float64 only", hint="use `--engine jit`, or float64")
    return {"single": True}


FILLERS = {"jit": jit_filler}
"""Name of an engine -> what draws its uniforms, where it brings something of its own; see `sampling.draws.Filler`."""
