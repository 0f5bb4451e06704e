"""The radius that holds initial data which are a function: a lattice must be at least as wide.

The function is evaluated along the axes, at 3602 places: at 0, and from 1e-18 to 1e18 times (D T)^(1/alpha), the length
over which data spread. It is then evaluated at equally spaced places within a thousand times the radius found.
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

_RAY = np.concatenate([[0.0], np.geomspace(1e-18, 1e18, 3601)])  # the first places, in spreads
_NEAR, _LOOKS = 1000.0, 40_001  # the farthest equally spaced place in radii, and their number
_ASKED = 12  # places at which the values for an array are compared with those for single numbers


def radius_of(initial: Initial, problem: Case, dim: int) -> float:
    """Return the radius that holds nine tenths of the data along the axes.

    A part narrower than a fiftieth of its distance is found if it lies within a thousand radii of the rest and is wider
    than a fortieth of the radius. Raises `InvalidInput` if the data are not finite, zero, or do not fall.
    """
    if isinstance(initial, str):
        return float((problem.diffusivity * problem.t_initial) ** (1.0 / problem.alpha))
    if isinstance(initial, Measured):
        return max(float(np.abs(axis[[0, -1]]).max()) for axis in initial.axes)
    assert callable(initial)
    ray = _RAY * float((problem.diffusivity * problem.span) ** (1.0 / problem.alpha))
    function = _at_places(initial, dim, ray)

    def held(r: np.ndarray) -> float:
        ways = [axis * sign for axis in np.eye(dim) for sign in (1.0, -1.0)]
        with np.errstate(all="ignore"):  # the caller's function may overflow so far out
            sizes = sum(np.abs(function(*(r * part for part in way))) for way in ways)
            density = r ** (dim - 1) * sizes
            parts = 0.5 * (density[1:] + density[:-1]) * np.diff(r)
        mass = np.concatenate([[0.0], np.cumsum(parts)])
        if not 0.0 < mass[-1] < np.inf:
            raise InvalidInput(
                "initial", initial, "data that are finite and not zero", "Give within."
            )
        return float(np.interp(0.9 * mass[-1], mass, r))

    radius = held(ray)
    if radius > 0.5 * ray[-1]:  # a constant, a step
        allowed = f"data that fall: a tenth of them lies beyond |x| = {radius:.2g}"
        raise InvalidInput(
            "initial", initial, allowed, "Give data that can be integrated, or within."
        )
    even = np.linspace(0.0, _NEAR * radius, _LOOKS)
    return held(np.union1d(ray, even))


def _at_places(initial: Callable[..., Any], dim: int, ray: np.ndarray) -> Callable[..., np.ndarray]:
    """Return the data as a function of arrays; it is called for single numbers if arrays give it other values."""
    one_by_one = np.vectorize(initial, otypes=[float])
    places = [ray[:: ray.size // _ASKED] * (1.0 - 0.25 * k) for k in range(dim)]
    with np.errstate(all="ignore"):
        try:
            given = _together(initial, *places), one_by_one(*places)
            same = np.allclose(*given, rtol=1e-12, atol=0.0, equal_nan=True)
        except (TypeError, ValueError):
            same = False
    return partial(_together, initial) if same else one_by_one


def _together(initial: Callable[..., Any], *x: np.ndarray) -> np.ndarray:
    return np.broadcast_to(np.asarray(initial(*x), dtype=float), x[0].shape)
