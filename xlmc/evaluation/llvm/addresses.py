"""Where arrays lie in memory, asked once of those that come again with every block: asking takes NumPy a while."""

from __future__ import annotations

from collections.abc import Hashable
from typing import Any

from numpy.typing import NDArray

__all__ = ["Addresses"]


class Addresses:
    """The addresses of the arrays last seen under each key; it keeps these arrays alive. For one thread."""

    def __init__(self) -> None:
        self._seen: dict[Hashable, tuple[NDArray[Any], int]] = {}

    def of(self, key: Hashable, array: NDArray[Any]) -> int:
        """The address of the first element."""
        seen = self._seen.get(key)
        if seen is not None and seen[0] is array:
            return seen[1]
        address: int = array.__array_interface__["data"][0]
        self._seen[key] = array, address
        return address
