"""Thin curved layers made flat: coordinates that are thin, less what a quadratic function of the others says of them.

Filters that ask for narrow ranges leave a layer that is thin in some directions and bent along the others; normal
distributions are not bent. A shear moves a coordinate by a function of others, so that volumes stay as they are.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

__all__ = ["Shear", "fitted_shear"]

Floats = NDArray[np.float64]

_POINTS_A_TERM: Final = 30
_DECIMALS: Final = 9


@dataclass(frozen=True, slots=True, eq=False)
class Shear:
    """Of (n, d) points, the first t coordinates being the thin ones: what a + b·x + x·C·x says of each.

    Attributes:
        constant: (t,) a.
        linear: (t, d − t) b.
        quadratic: (t, d − t, d − t) C.
    """

    constant: Floats
    linear: Floats
    quadratic: Floats

    @property
    def thin(self) -> int:
        """How many are thin."""
        return self.constant.size

    def shift(self, others: Floats) -> Floats:
        """(n, t) what (n, d − t) other coordinates say of the thin ones."""
        found: Floats = self.constant + np.einsum("nk,tk->nt", others, self.linear)
        for place, square in enumerate(self.quadratic):
            found[:, place] += np.einsum("nk,nk->n", np.einsum("nj,jk->nk", others, square), others)
        return found


def fitted_shear(thin: Floats, others: Floats, weights: Floats) -> Shear:
    """The shear that leaves least of (n, t) thin coordinates, by least squares with (n,) weights.

    With few points for so many products of coordinates, squares alone are taken; with fewer still, nothing is moved.
    """
    count, width = others.shape[1], thin.shape[1]
    first, second = np.triu_indices(count)
    affordable = len(others) // _POINTS_A_TERM
    if 1 + count + first.size > affordable:
        first = second = np.arange(count)
    if not width or 1 + count + first.size > affordable:
        return Shear(np.zeros(width), np.zeros((width, count)), np.zeros((width, count, count)))
    terms = np.concatenate([np.ones((len(others), 1)), others, others[:, first] * others[:, second]], axis=1)
    roots = np.sqrt(weights / weights.mean())[:, None]
    solved = np.round(np.linalg.lstsq(terms * roots, thin * roots, rcond=1e-9)[0].T, _DECIMALS)
    quadratic = np.zeros((width, count, count))
    quadratic[:, first, second] = solved[:, 1 + count :]
    return Shear(solved[:, 0], solved[:, 1 : 1 + count], quadratic)
