from __future__ import annotations

import numpy as np
import pytest

from xlmc.montecarlo.columns import Folder


@pytest.fixture(scope="session")
def stored():
    """`stored(values)`: the same column on disk."""

    def store(values):
        values = np.ascontiguousarray(values)
        folder = Folder()
        folder.append("column", [values])
        return folder.array("column", values.dtype)

    return store
