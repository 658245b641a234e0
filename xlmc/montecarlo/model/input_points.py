"""Read the values that somebody gives the live assumptions."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from xlmc.errors import SimulationError
from xlmc.montecarlo.definitions.definitions import Assumption
from xlmc.montecarlo.distributions.spelling import by_names, name_key

__all__ = ["input_points"]


def input_points(
    assumptions: Sequence[Assumption], live: Sequence[Assumption], inputs: Mapping[str, ArrayLike]
) -> tuple[dict[str, NDArray[np.float64]], int]:
    """Values of every live assumption as engines take them: name -> `(n,)`, in the order of `live`, and `n`.

    Args:
        assumptions: of the workbook.
        live: those of them that are drawn.
        inputs: name of the assumption -> `(n,)` or a number.

    Raises:
        SimulationError: an assumption is missing, unknown or frozen, or the values are of different lengths.
    """
    spelt = _spelt(assumptions, live, inputs)
    given = {spelt[name]: np.asarray(values, np.float64) for name, values in inputs.items()}
    sizes = {values.size for values in given.values() if values.ndim} - {1} or {1}
    if len(sizes) > 1 or any(values.ndim > 1 for values in given.values()):
        hint = "give lists of the same length"
        raise SimulationError("an assumption takes one number or one list of numbers", hint=hint)
    (n,) = sizes
    return {a.name: np.ascontiguousarray(np.broadcast_to(given[a.name], (n,))) for a in live}, n


def _spelt(assumptions: Sequence[Assumption], live: Sequence[Assumption], names: Iterable[str]) -> dict[str, str]:
    """Names of all live assumptions, as somebody typed them -> as defined.

    Raises:
        SimulationError: one is missing, unknown or frozen.
    """
    known, result = by_names(assumptions), dict[str, str]()
    for name in names:
        assumption = known.get(name_key(name))
        if assumption is None:
            hint = f"choose from {', '.join(repr(a.name) for a in live)}"
            raise SimulationError(f"there is no assumption {name!r}", hint=hint)
        if assumption.frozen:
            raise SimulationError(f"the assumption {name!r} is frozen", hint="it is held at its cell's own value")
        result[name] = assumption.name
    if missing := [a.name for a in live if a.name not in result.values()]:
        raise SimulationError(f"no values for the assumption {missing[0]!r}", hint="give every live assumption")
    return result
