from __future__ import annotations

import hashlib
import struct
from types import SimpleNamespace

import numpy as np

from xlmc.results.record.fingerprint import fingerprint


def _run(index, inputs, forecasts):
    return SimpleNamespace(
        trial_index=np.array(index),
        inputs={str(n): np.array(values) for n, values in enumerate(inputs)},
        forecasts={str(n): np.array(values) for n, values in enumerate(forecasts)},
    )


def test_it_is_the_hash_of_indices_inputs_and_forecasts():
    expected = hashlib.sha256(struct.pack("<2q", 3, 8) + struct.pack("<4d", 0.5, 1.5, -1.0, np.nan)).hexdigest()
    assert fingerprint(_run([3, 8], [[0.5, 1.5]], [[-1.0, np.nan]])) == expected


def test_every_missing_number_counts_the_same():
    other = struct.unpack("<d", struct.pack("<Q", 0xFFF8_0000_0000_0001))[0]
    assert fingerprint(_run([1], [[other]], [[0.0]])) == fingerprint(_run([1], [[np.nan]], [[0.0]]))


def test_it_depends_on_the_seed_and_not_on_the_threads(model, run):
    assert fingerprint(model.simulate(jobs=2)) == fingerprint(run)
    assert fingerprint(model.simulate(seed=6)) != fingerprint(run)


def test_one_bit_changes_it():
    assert fingerprint(_run([1], [[1.0]], [])) != fingerprint(_run([1], [[np.nextafter(1.0, 2.0)]], []))
