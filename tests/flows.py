"""Velocities |a| <= 5 sqrt(2) in the plane, and what transport makes of them between the particles of a domain."""

from __future__ import annotations

import numpy as np


def constant(x, y):
    return 5.0 + 0.0 * x, -2.0 + 0.0 * x


def inward(x, y):
    return -5.0 * x, -5.0 * y


def outward(x, y):
    return 5.0 * x, 5.0 * y


def shear(x, y):
    return 5.0 * y, 0.0 * x


PRESSED = {constant: 0.0, shear: 0.0, outward: -10.0, inward: 10.0}  # max(-div a)


def matrix(one, f):
    """The matrix of f between the particles."""
    columns = (f(e.reshape(one.x.shape)).ravel() for e in np.eye(one.x.size))
    return np.stack(list(columns), axis=1)


def transport(one, velocity):
    return matrix(one, lambda v: one.carried(v, 0.0 * v, velocity))


def whole(one, flow):
    return matrix(one, one.applied) + transport(one, flow(one.x, one.y))


def fastest(one, flow):
    """The greatest rate at which sum V v^2 / 2 can grow, over sum V v^2, and the round-off in it."""
    root = np.sqrt(one.volumes.reshape(-1))
    form = root[:, None] * whole(one, flow) / root
    rate = np.linalg.eigvalsh(0.5 * (form + form.T))[-1]
    return rate, 100.0 * np.finfo(float).eps * np.abs(form).max()


def mean(one, u):
    return one.total(np.abs(u)) / one.volumes.sum()
