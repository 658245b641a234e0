from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.sampling.copula import nearest_correlation


def symmetric(k, seed):
    values = np.random.default_rng(seed).uniform(-1, 1, (k, k))
    return np.triu(values, 1) + np.triu(values, 1).T + np.eye(k)


def test_the_published_examples():
    """Higham 2002, section 4."""
    found = nearest_correlation(np.array([[1.0, 1.0, 0.0], [1.0, 1.0, 1.0], [0.0, 1.0, 1.0]]))
    assert found[[0, 0, 1], [1, 2, 2]] == pytest.approx([0.7607, 0.1573, 0.7607], abs=5e-5)
    band = 2 * np.eye(4) - np.eye(4, k=1) - np.eye(4, k=-1)
    found = nearest_correlation(band)
    assert found[0, 1:] == pytest.approx([-0.8084, 0.1916, 0.1068], abs=5e-5)
    assert found[1, 2] == pytest.approx(-0.6562, abs=5e-5)


@given(st.integers(2, 8), st.integers(0, 10_000))
def test_it_is_a_correlation_matrix_and_no_other_is_nearer(k, seed):
    """Nearest on a convex set: from it, the way to any other correlation matrix leads away from the one asked for."""
    asked = symmetric(k, seed)
    found = nearest_correlation(asked)
    assert np.array_equal(found, found.T) or np.allclose(found, found.T, atol=1e-12)
    assert np.array_equal(np.diagonal(found), np.ones(k))
    assert np.linalg.eigvalsh(found)[0] > -1e-7
    rng = np.random.default_rng(seed)
    for _ in range(5):
        rows = rng.normal(size=(k, rng.integers(1, k + 1)))
        rows /= np.linalg.norm(rows, axis=1, keepdims=True)
        assert np.sum((asked - found) * (rows @ rows.T - found)) < 1e-5


@given(st.integers(2, 8), st.integers(0, 10_000))
def test_a_correlation_matrix_is_its_own(k, seed):
    rows = np.random.default_rng(seed).normal(size=(k, k + 2))
    rows /= np.linalg.norm(rows, axis=1, keepdims=True)
    given_matrix = rows @ rows.T
    np.fill_diagonal(given_matrix, 1.0)
    assert nearest_correlation(given_matrix) == pytest.approx(given_matrix, abs=1e-9)
