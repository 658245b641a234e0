"""The engines, a row each: the command line, settings, records and runs know them from here.

To add one, write a module or a folder beside this module with its `Program` (see `engine.py`), and its row below;
describe it in docs/engines.md. docs/adding.md has an example. Nothing is imported before an engine computes, so that
`--help` is quick.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Final, NamedTuple

from xlmc.engine.llvm import jit_filler, jit_program

if TYPE_CHECKING:
    from xlmc.engine.engine import Program

__all__ = ["ENGINES", "Engine"]


class Engine(NamedTuple):
    """One way to compute the trials of a run.

    Attributes:
        key: its name in options, settings, records and saved runs.
        what: what it is for, in a clause; empty for the usual one.
        load: gives what makes its program of a lowering, filters, forecasts and inputs whose draws may be errors.
            Filters are evaluated on all trials, forecasts on the survivors. It raises `SimulationError` where a library
            is missing, and `FormulaError` where the engine has no such formulas.
        bounded: it is given the `NodeBounds`, too, as `bounds`.
        filler: draws its uniforms, where it brings something of its own; see `sampling.draws.Filler`.
        library: the package that it needs besides those of every engine; empty for none.
        portable: its workers can be pickled: to unpickle one takes a fraction of the imports that a `RunSpec` needs.
        process_blocks: blocks that take longer than a process to start: a quarter of a second, or half of one where it
            is not portable.
        searches: its runs may turn to a search for rare trials, which the engine numpy computes.
    """

    key: str
    what: str
    load: Callable[[], Callable[..., Program]]
    bounded: bool = False
    filler: Callable[..., Callable[[int], None]] | None = None
    library: str = ""
    portable: bool = False
    process_blocks: float = math.inf
    searches: bool = True


def _numpy() -> Callable[..., Program]:
    from xlmc.engine.numpy.numpy_engine import NumpyProgram

    return NumpyProgram.of


def _formulas() -> Callable[..., Program]:
    from xlmc.engine.reference.formulas_engine import FormulasProgram

    return FormulasProgram


_ROWS: Final = (
    Engine("numpy", "", _numpy, bounded=True, portable=True, process_blocks=128),
    Engine("jit", "compiled, for long runs", lambda: jit_program, filler=jit_filler, library="llvmlite"),
    Engine("formulas", "the slow reference", _formulas, process_blocks=4, searches=False),
)

ENGINES: Final[dict[str, Engine]] = {row.key: row for row in _ROWS}
"""The engines by their keys."""
