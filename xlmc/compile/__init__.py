"""Graph of formulas → one callable over blocks of trials, by the engine of one's choice."""

from collections.abc import Callable, Mapping

from xlmc.compile.engine import Column, Evaluator, Program, Target
from xlmc.compile.formulas_engine import FormulasProgram
from xlmc.compile.jit import jit_filler, jit_program
from xlmc.compile.lower import Lowering
from xlmc.compile.numpy_engine import NumpyProgram
from xlmc.compile.widening import widened

__all__ = ["ENGINES", "FILLERS", "Column", "Evaluator", "Lowering", "Program", "Target", "widened"]

ENGINES: Mapping[str, Callable[..., Program]] = {
    "numpy": NumpyProgram,
    "jit": jit_program,
    "formulas": FormulasProgram,
}
"""Name of an engine -> program of (lowering, filters, forecasts, inputs whose draws may be errors)."""

FILLERS = {"jit": jit_filler}
"""Name of an engine -> what draws its uniforms, where it brings something of its own; see `sampling.draws.Filler`."""
