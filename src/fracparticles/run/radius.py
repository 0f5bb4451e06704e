"""The radius that holds initial data which are a function: how wide a lattice must be at least.

They are looked at along the axes, at 2402 places from 1e-12 to 1e12 of their unit of length, and then evenly, within a
thousand of the radius that is found there.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from fracparticles.data.interpolated import Measured
from fracparticles.errors import InvalidInput
from fracparticles.run.case import Case
from fracparticles.run.initial import Initial

__all__ = ["radius_of"]

_RAY = np.concatenate([[0.0], np.geomspace(1e-12, 1e12, 2401)])  # where data are looked at
_NEAR, _LOOKS = 1000.0, 40_001  # and evenly, within so many of the radius that is found there
_ASKED = 12  # places at which a function of arrays is compared with one of numbers


def radius_of(initial: Initial, problem: Case, dim: int) -> float:
    """Return the radius that holds nine tenths of the data along the axes, of those within 1e12 of their unit.

    A part narrower than a fiftieth of its distance is found if it is within a thousand radii of the rest, and wider
    than a fortieth of that radius.
    """
    if isinstance(initial, str):
        return float((problem.diffusivity * problem.t_initial) ** (1.0 / problem.alpha))
    if isinstance(initial, Measured):
        return max(float(np.abs(axis[[0, -1]]).max()) for axis in initial.axes)
    assert callable(initial)
    function = _at_places(initial, dim)

    def held(r: np.ndarray) -> float:
        rays = [axis * sign for axis in np.eye(dim) for sign in (1.0, -1.0)]
        with np.errstate(all="ignore"):  # a function of the caller's may overflow so far out
            sizes = sum(np.abs(function(*(r * part for part in ray))) for ray in rays)
            density = r ** (dim - 1) * sizes
            parts = 0.5 * (density[1:] + density[:-1]) * np.diff(r)
        mass = np.concatenate([[0.0], np.cumsum(parts)])
        if not 0.0 < mass[-1] < np.inf:
            raise InvalidInput(
                "initial", initial, "data that are finite and not zero", "Give within."
            )
        return float(np.interp(0.9 * mass[-1], mass, r))

    radius = held(_RAY)
    if radius > 0.5 * _RAY[-1]:  # a constant, a step
        allowed = f"data that fall: a tenth of them lies beyond |x| = {radius:.2g}"
        raise InvalidInput(
            "initial", initial, allowed, "Give data that can be integrated, or within."
        )
    even = np.linspace(0.0, _NEAR * radius, _LOOKS)
    return held(np.union1d(_RAY, even))


def _at_places(initial: Callable[..., Any], dim: int) -> Callable[..., np.ndarray]:
    """Return the data as a function of arrays; asked one by one, if some places say that it is another of arrays."""
    one_by_one = np.vectorize(initial, otypes=[float])
    places = [_RAY[:: _RAY.size // _ASKED] * (1.0 - 0.25 * k) for k in range(dim)]
    with np.errstate(all="ignore"):
        try:
            given = _together(initial, *places), one_by_one(*places)
            same = np.allclose(*given, rtol=1e-12, atol=0.0, equal_nan=True)
        except (TypeError, ValueError):
            same = False
    return partial(_together, initial) if same else one_by_one


def _together(initial: Callable[..., Any], *x: np.ndarray) -> np.ndarray:
    return np.broadcast_to(np.asarray(initial(*x), dtype=float), x[0].shape)
