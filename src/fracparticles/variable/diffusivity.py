"""Variable diffusivity, du/dt = div(D(x, t) grad^beta u), in three forms:

FPSE: the diffusivity is in the flux, Eqs. (19), (25). Conservative.

    Q_i = -(D_i / epsilon^beta) sum_j V_j u_j F_epsilon(x_i - x_j),
    du_i/dt = -(1 / epsilon) sum_j V_j (Q_j + Q_i) eta1_epsilon(x_i - x_j).

DD: the product rule, Eq. (10) and the gradient of (19). D' is the central difference of D that has the order of the
kernels. Not conservative.

    du_i/dt = (D_i / epsilon^alpha) sum_j V_j u_j G_epsilon(x_i - x_j) + D'_i . (grad^beta u)_i.

exchange: Eq. (34) with the mean diffusivity of a pair. It is conservative and symmetric, but solves another equation:
with the constant operator L = -(-Laplacian)^(alpha/2) it converges to (D L u + L(D u) - u L D) / 2.

    du_i/dt = (alpha / epsilon^alpha) sum_j V_j (D_i + D_j) / 2 (u_j - u_i) K_epsilon(x_j - x_i).

In an open exterior u continues with its tail. The flux of FPSE, and therefore D, is needed as far beyond the ends as
the divergence reaches. The exchange takes D beyond an end to be constant, with its value at that end.
"""

from __future__ import annotations

from threading import Lock
from typing import Any

import numpy as np

from fracparticles.arguments import choice, finite_array, instance, of_shape, operand
from fracparticles.errors import InvalidInput
from fracparticles.lattice.exterior import LineFarField
from fracparticles.schemes import SCHEMES
from fracparticles.schemes.base import OnePass
from fracparticles.schemes.setting import Setting
from fracparticles.variable.exterior import tails_of
from fracparticles.variable.gradient import ExchangeDivergence, FractionalGradient
from fracparticles.variable.resolution import (
    UNRESOLVED,
    UNRESOLVED_BY_PAIRS,
    warn_unresolved,
    warn_unsettled,
)
from fracparticles.variable.sums import EvenSum

__all__ = ["FORMS", "VariableDiffusivity"]

FORMS = {"FPSE": "FPSE", "DD": "DD", "exchange": "KPSE"}  # form: the scheme with its kernels


class VariableDiffusivity:
    """div(D grad^beta u) on a lattice, or the operator of the exchange.

    Parameters
    ----------
    form : {"FPSE", "DD", "exchange"}
        See the module.
    setting : Setting
        Its diffusivity must be 1, because D is given at the points.
    tail : float, optional
        p of u ~ |x|^-p in an open exterior; left out, it is n + alpha, as for the fundamental solution.

    Attributes
    ----------
    points : tuple of array
        Coordinates where D is needed, one array for each dimension; they broadcast to `points_shape`.
    points_shape : tuple of int
    conservative : bool
        Whether the total strength is invariant (truncated exterior).

    Raises
    ------
    InvalidInput
        If there is no such form, or if it does not exist with this setting.

    Warns
    -----
    AccuracyWarning
        Once, when D is given, if it varies near the ends of an open exterior, or faster than the particles resolve.
    """

    def __init__(self, form: str, setting: Setting, tail: float | None = None) -> None:
        self.form = choice("form", form, tuple(FORMS))
        self.setting = instance("setting", setting, Setting)
        _check(form, setting)
        usual = setting.dim + setting.alpha
        tails = tails_of(setting, tail, (usual, usual))
        self.conservative = form != "DD"
        self._pad, self._lock = 0, Lock()
        self._looked_at = np.zeros(0)  # the last D that was judged
        # True until a warning was given: one is enough.
        self._settled, self._resolved = setting.is_open, True
        if form == "FPSE":
            self._pad = ExchangeDivergence.reach(setting) if setting.is_open else 0
            self._gradient = FractionalGradient(setting, self._pad, tails)
            self._divergence = ExchangeDivergence(setting, self._pad)
        elif form == "DD":
            self._pad = setting.order // 2
            self._gradient = FractionalGradient(setting, 0, tails)
            self._laplacian = EvenSum(_scheme("DD"), setting, tails)
            self._difference = _central_difference(setting.order) / setting.spacing
        else:
            self._exchange = EvenSum(_scheme("KPSE"), setting, tails)
            self._beyond = _beyond(self._exchange)
        count = setting.n + self._pad
        line = setting.spacing * np.arange(-count, count + 1.0)
        self.points = tuple(np.meshgrid(*(line,) * setting.dim, indexing="ij", sparse=True))
        self.points_shape = (line.size,) * setting.dim

    def apply(self, u: np.ndarray, diffusivity: Any) -> np.ndarray:
        """Return du/dt for the strengths u, shape `setting.shape`, and D at the points.

        Raises
        ------
        InvalidInput
            If D is not finite and not negative, or has another shape.
        """
        u = np.ascontiguousarray(operand("u", u, self.setting.shape))
        d = self._checked(diffusivity)
        rate = {"FPSE": self._flux, "DD": self._product_rule, "exchange": self._mean}[self.form]
        with self._lock:  # the sums keep work arrays
            return rate(u, d)

    def spectral_radius(self, diffusivity: Any) -> float:
        """Return an upper bound of |lambda|; for an open exterior it is that of the lattice without continuation."""
        d = self._checked(diffusivity)
        if self.form == "FPSE":
            return float(d.max()) * self._gradient.norm * self._divergence.norm
        if self.form == "DD":
            slope = np.sqrt(sum(np.square(part) for part in self._slopes(d)))
            largest = float(np.abs(self._inner(d)).max())
            return largest * self._laplacian.norm + float(slope.max()) * self._gradient.norm
        centre = abs(self._exchange.weights.flat[0])  # cancels from u_j - u_i
        return 2.0 * float(d.max()) * (self._exchange.norm - centre)

    def _checked(self, diffusivity: Any) -> np.ndarray:
        d = finite_array("diffusivity", diffusivity)
        if d.ndim == 0:
            d = np.full(self.points_shape, d[()])
        of_shape("diffusivity", d, self.points_shape, "one number, or one for each of the points")
        if d.min() < 0.0:
            raise InvalidInput(
                "diffusivity", float(d.min()), "no negative number", "Give D(x, t) >= 0."
            )
        if (self._settled or self._resolved) and not np.array_equal(d, self._looked_at):
            self._judge(d)
        return d

    def _judge(self, d: np.ndarray) -> None:
        """Warn of a D that varies near the ends, or between the particles; a D that changes in time is judged again."""
        self._looked_at = d.copy()
        if self._settled:
            self._settled = not warn_unsettled("diffusivity", self._inner(d), self.setting.n)
        if self._resolved:
            most = UNRESOLVED_BY_PAIRS if self.form == "exchange" else UNRESOLVED
            self._resolved = not warn_unresolved("diffusivity", d, self.setting, most)

    def _inner(self, d: np.ndarray) -> np.ndarray:
        """D at the particles."""
        inner = slice(self._pad, self._pad + self.setting.size)
        return d[(inner,) * self.setting.dim]

    def _flux(self, u: np.ndarray, d: np.ndarray) -> np.ndarray:
        return self._divergence(d * self._gradient(u))

    def _product_rule(self, u: np.ndarray, d: np.ndarray) -> np.ndarray:
        total = self._inner(d) * self._laplacian(u)
        for slope, component in zip(self._slopes(d), self._gradient(u), strict=True):
            total += slope * component
        return total

    def _slopes(self, d: np.ndarray) -> list[np.ndarray]:
        """D' at the particles, one array for each dimension."""
        size, pad, slopes = self.setting.size, self._pad, []
        inner = slice(pad, pad + size)
        for axis in range(d.ndim):
            lines = np.moveaxis(d, axis, 0)
            slope = sum(
                c * (lines[pad + m : pad + m + size] - lines[pad - m : pad - m + size])
                for m, c in enumerate(self._difference, 1)
            )
            slope = slope[(slice(None),) + (inner,) * (d.ndim - 1)]
            slopes.append(np.moveaxis(slope, 0, axis))
        return slopes

    def _mean(self, u: np.ndarray, d: np.ndarray) -> np.ndarray:
        """(D_i + D_j) (u_j - u_i) = D_i (u_j - u_i) + (D_j u_j - D_i u_i) - u_i (D_j - D_i): three sums."""
        sums, far = self._exchange.inside, self._exchange.far
        total = 0.5 * (d * sums(u) + sums(d * u) - u * sums(d) - d * u * sums(np.ones_like(u)))
        if isinstance(far, LineFarField):
            last, right, left = u.size - 1 - far.depth, far.right, far.left
            from_right, from_left = u[last] @ right, u[far.depth] @ left
            total += 0.5 * (d + d[-1]) * (from_right - u * self._beyond[::-1])
            total += 0.5 * (d + d[0]) * (from_left - u * self._beyond)
        return total


def _scheme(name: str) -> OnePass:
    return instance("scheme", SCHEMES[name], OnePass)


def _check(form: str, setting: Setting) -> None:
    """Refuse a setting in which a form does not exist."""
    scheme = SCHEMES[FORMS[form]]
    # In the plane the divergence uses general sums here, and exists for every order.
    if form == "FPSE" and setting.dim == 2:
        scheme = SCHEMES["DD"]
    scheme.check(setting.dim, setting.order, setting.family)
    if setting.dim > 2:
        raise InvalidInput("dim", setting.dim, "1 or 2", "Take the line or the plane.")
    if setting.diffusivity != 1.0:
        raise InvalidInput("setting.diffusivity", setting.diffusivity, "1", "Put it into D.")
    if form == "exchange" and setting.dim > 1 and setting.is_open:
        raise InvalidInput(
            "exterior",
            "open",
            "'truncated' for the exchange in the plane",
            "Truncate it, or take FPSE.",
        )


def _central_difference(order: int) -> np.ndarray:
    """c_m of f'(0) = sum_(m = 1 .. order / 2) c_m (f(m) - f(-m)) + O(h^order)."""
    m = np.arange(1, order // 2 + 1, dtype=float)
    moments = m ** (2.0 * np.arange(m.size)[:, None] + 1.0)
    return np.linalg.solve(2.0 * moments, np.eye(m.size)[0])


def _beyond(exchange: EvenSum) -> np.ndarray:
    """The sum of w_m over all m > i, i = 0 .. N - 1: the weights of all places beyond the left end, for particle i."""
    w = exchange.weights
    if w.ndim > 1:
        return np.zeros(0)
    half = 0.5 * (exchange.total - w[0])
    return half - np.cumsum(np.append(0.0, w[1:]))
