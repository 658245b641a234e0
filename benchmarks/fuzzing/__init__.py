"""Hostile input for xlmc: workbooks, formulas, tables and saved runs that were broken on purpose.

Each kind of input is a module with `make` (a random input, a function of its generator alone) and `run` (give it to
xlmc). `verdict` says which outcomes are fine, `child` runs inputs under limits of time and memory, `campaign` keeps
children at work and gathers what they find.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from importlib import import_module
from typing import Final

from fuzzing import foreign_parts, formulas, hidden_blocks, live_state, old_books, runs, tables, zips
from fuzzing.inputs import Kind

__all__ = ["BLOCK", "KINDS", "warm_up"]

KINDS: Final[Mapping[str, Kind]] = {
    "zip": Kind(zips.make, zips.run),
    "formulas": Kind(formulas.make, formulas.run),
    "tables": Kind(tables.make, tables.run),
    "runs": Kind(runs.make, runs.run),
    "blocks": Kind(hidden_blocks.make, hidden_blocks.run),
    "old": Kind(old_books.make, old_books.run),
    **{focus: Kind(partial(foreign_parts.make, focus), foreign_parts.run) for focus in foreign_parts.FOCUSES},
    "recent": Kind(live_state.make, live_state.run),
}
BLOCK: Final = 128
"""Trials that xlmc evaluates at once here; 32,768 are slow where few are asked for."""

_WANTED: Final = (
    "formulas",
    "formulas.functions.stat",
    "llvmlite.binding",
    "olefile",
    "openpyxl",
    "scipy.linalg",
    "scipy.optimize",
    "scipy.special",
    "xlmc.cli",
    "xlmc.engine.reference.formulas_engine",
    "xlmc.engine.llvm",
    "xlmc.excel.functions.families",
    "xlmc.outputs.page",
    "xlmc.outputs.replay",
    "xlmc.analysis.studies.verify",
    "xlmc.excel.workbook.other_formats.joined_package",
    "xlsxwriter",
)


def warm_up() -> None:
    """Import what xlmc imports when it needs it, so that children begin with it, and make blocks small."""
    for module in _WANTED:
        import_module(module)
    setattr(import_module("xlmc.montecarlo.simulation.simulate"), "BLOCK", BLOCK)  # noqa: B010 - it is final to all others
