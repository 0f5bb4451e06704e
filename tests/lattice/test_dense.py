"""Spectra and powers of matrices that are known."""

from __future__ import annotations

import numpy as np
import pytest

from fracparticles.lattice.dense import norms_of_powers, spectrum

TURN = np.array([[0.0, -1.0], [1.0, 0.0]])
JORDAN = np.array([[1.0, 1.0], [0.0, 1.0]])


def test_a_symmetric_matrix():
    found = spectrum(np.array([[2.0, 1.0], [1.0, 2.0]]))
    assert found[:4] == pytest.approx((2, 1.0, 3.0, 0.0))
    assert found.asymmetry == found.departure == 0.0


def test_a_rotation_is_normal_but_not_symmetric():
    found = spectrum(TURN)
    assert found[:4] == pytest.approx((2, 0.0, 0.0, 1.0))
    assert found.asymmetry == pytest.approx(2.0)  # A - A^T = 2 A
    assert found.departure == 0.0


def test_a_jordan_block_is_not_normal():
    # A A^T - A^T A = diag(1, -1), |A|^2 = 3
    assert spectrum(JORDAN).departure == pytest.approx(np.sqrt(2.0) / 3.0)


def test_powers():
    assert norms_of_powers(TURN, 6, 2) == pytest.approx([1.0] * 4)
    # A^n = [[1, n], [0, 1]], whose norm is (n + sqrt(n^2 + 4)) / 2
    n = 2.0 ** np.array([0, 3, 6, 9])
    assert norms_of_powers(JORDAN, 9, 3) == pytest.approx(0.5 * (n + np.sqrt(n**2 + 4.0)))
