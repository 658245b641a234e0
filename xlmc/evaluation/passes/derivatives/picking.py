"""Functions that pick cells out of ranges: which they pick is asked of the function itself, by numbering the cells."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from xlmc.evaluation.passes.derivatives.jet import Jet, aligned
from xlmc.evaluation.passes.derivatives.rules import Operand
from xlmc.functions.values import LOGICAL, NUMBER, Bools, Value

__all__ = ["Drawer", "by_value", "flat", "joined"]


def flat(jet: Jet, value: Value) -> Jet:
    """The cells of a value side by side, `(n, m)`."""
    n, size = value.shape[0], int(np.prod(value.shape[1:]))

    def change(part: NDArray[Any], axes: int) -> NDArray[Any]:
        return np.broadcast_to(part, (*part.shape[:axes], *value.shape)).reshape(*part.shape[:axes], n, size)

    return jet.each(change)


class Drawer(NamedTuple):
    """The cells of some operands in one row, numbered from 1; 0 stands for what is none of them.

    Attributes:
        cells: `(n, m)`, none of them active where `active` is empty.
        tags: the operands with their numbers replaced by those of the cells.
    """

    cells: Jet
    tags: list[Value]

    @classmethod
    def of(cls, operands: Sequence[Operand]) -> Drawer:
        """The cells of these operands."""
        jets = aligned([flat(operand.jet, operand.value) for operand in operands])
        n = max(jet.x.shape[0] for jet in jets)
        tags, count = [], 0
        for operand in operands:
            shape = operand.value.shape[1:]
            size = int(np.prod(shape))
            numbers = np.arange(count + 1.0, count + size + 1).reshape(1, *shape)
            count += size
            tags.append(_tagged(operand.value, numbers))
        return cls(joined(jets, n), tags)

    def drawn(self, found: Value, result: Value) -> Jet:
        """The cells that a function found among the tags, as its result."""
        places = np.where(found.kinds == NUMBER, found.numbers, 0.0)
        places = np.broadcast_to(places, found.shape).astype(np.intp)
        n = max(places.shape[0], self.cells.x.shape[0])
        trials = np.arange(n).reshape(n, *(1,) * (places.ndim - 1))

        def pick(part: NDArray[Any], axes: int) -> NDArray[Any]:
            padded = np.concatenate([np.zeros((*part.shape[:-1], 1)), part], axis=-1)
            wide = np.broadcast_to(padded, (*padded.shape[:axes], n, padded.shape[-1]))
            return wide[..., trials, places]

        return self.cells.each(pick, result.numbers)


def _tagged(value: Value, numbers: NDArray[np.float64]) -> Value:
    """Texts and errors stay what they are; logicals become numbers, that their tags are not cut to TRUE."""
    kinds = np.where(value.kinds == LOGICAL, np.uint8(NUMBER), value.kinds)
    shape = np.broadcast_shapes(kinds.shape, numbers.shape)
    return Value(np.broadcast_to(numbers, shape), np.broadcast_to(kinds.astype(np.uint8), shape), value.texts)


def joined(jets: Sequence[Jet], n: int) -> Jet:
    """Cells side by side."""

    def side(name: str, axes: int) -> Any:
        parts = [getattr(jet, name) for jet in jets]
        if all(part is None for part in parts):
            return None
        lead = next(part.shape[:axes] for part in parts if part is not None)
        full = [
            np.broadcast_to(0.0 if part is None else part, (*lead, n, jet.x.shape[-1]))
            for part, jet in zip(parts, jets, strict=True)
        ]
        return np.concatenate(full, axis=-1)

    second = side("second", 2) if all(jet.second is not None for jet in jets if jet.active) else None
    rest = side("first", 1), second, side("error", 1), side("second_error", 2)
    return Jet(side("x", 0), jets[0].active, *rest)


def by_value(cells: Jet, counts: Bools, wanted: NDArray[np.float64]) -> tuple[Jet, NDArray[np.intp]]:
    """The first cell of each trial that has the wanted value, and its place.

    Args:
        cells: `(n, m)`.
        counts: `(n, m)` which of them count.
        wanted: `(n,)`. Where several cells have it and do not change alike, there is no derivative.
    """
    same = counts & (cells.x == wanted[:, None])
    places = same.argmax(axis=1)
    trials = np.arange(same.shape[0])
    whole = cells.spread()
    there = same.any(axis=1)
    picked = whole.each(lambda part, _: np.where(there, part[..., trials, places], 0.0))
    apart = (whole.first != picked.first[..., None]).any(axis=0) & same
    alone = replace(picked, x=wanted).lost(apart.any(axis=1))
    return alone, places
