from __future__ import annotations

import numpy as np

from xlmc.engine.graph.graph import Dag
from xlmc.engine.numpy.sequence import Buffers
from xlmc.excel.functions import Kind


def test_a_buffer_is_taken_again_once_it_is_given_back_and_only_for_its_kind():
    buffers = Buffers(Dag())
    first, second, logical = (buffers.take_for(kind) for kind in (Kind.NUMBER, Kind.NUMBER, Kind.LOGICAL))
    assert (first, second, logical) == (0, 1, 2)
    assert buffers.trial_bytes == 8 + 8 + 1
    buffers.give_back(first)
    assert buffers.take_for(Kind.LOGICAL) == 3
    assert buffers.take_for(Kind.NUMBER) == first
    assert buffers.trial_bytes == 8 + 8 + 1 + 1
    arrays = buffers.allocate(16)
    assert [(array.shape, array.dtype) for array in arrays] == [
        ((16,), np.dtype(kind)) for kind in (np.float64, np.float64, np.bool_, np.bool_)
    ]
    assert all(array.ctypes.data % 64 == 0 for array in arrays)
