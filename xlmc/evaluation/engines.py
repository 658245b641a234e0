"""The engines by name, and what each takes and brings."""

from collections.abc import Callable, Mapping
from typing import Any

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


def options_of(engine: str, between: Mapping[str, Bounds]) -> dict[str, Any]:
    """What a program of the engine takes besides.

    Args:
        engine: its name.
        between: name of an input -> its bounds, for engines that make use of them.
    """
    return {"between": between} if engine == "numpy" else {}


FILLERS = {"jit": jit_filler}
"""Name of an engine -> what draws its uniforms, where it brings something of its own; see `sampling.draws.Filler`."""
