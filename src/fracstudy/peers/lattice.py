"""What the peers on a lattice x_i = i h, i = -n .. n, share.

All are Toeplitz, (A u)_i = h^(-alpha) sum_j a_{i-j} u_j, with a_m -> C |m|^(-1-alpha) for large m (`tail_constant`).
Outside the lattice u is zero (`truncated`), or it falls like |x|^(-1-alpha) (`open`): Huang & Oberman's
far-field condition, here for all of them (`exterior.tabulated_far_field`).

In time, exp(A t) is one Chebyshev series (`series`; several where one would lose digits, see `integrators.pieces`), or,
where the symbol a(theta) of A is known, one lattice sum (`convolution`, see `propagator`).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any

import numpy as np
from scipy.fft import next_fast_len, rfft

from fracparticles.lattice.operators import ConvolutionOperator
from fracparticles.special.tails import tail_constant
from fracparticles.time import Flow, exponential_flow
from fracparticles.time.propagator import propagator, tabulated_operator
from fracstudy.peers.base import Peer, Task, half_intervals
from fracstudy.peers.plane import Squares, truncated_plane

__all__ = ["LatticeSolver", "lattice_peer"]

Weights = Callable[[float, int], np.ndarray]  # (alpha, count) -> a_m, m = 0 .. count - 1
Symbol = Callable[[np.ndarray, float], np.ndarray]  # (theta, alpha) -> a(theta)

_MARGIN = 1e-6  # of the range, below its low end: what the sampling of the symbol may miss
_OVERSAMPLING = 4


@dataclass(frozen=True)
class LatticeSolver:
    """A Toeplitz peer made ready, see `base.Solver`.

    Attributes
    ----------
    x, volumes : array, shape (N,)
        The lattice, and h.
    make_operator : callable
        Returns A.
    series : Flow or None
        exp(A t) by Chebyshev series; None if there is a propagator.
    propagator : ConvolutionOperator or None
        exp(A t) as one lattice sum.
    interval : tuple of float or None
        What holds the eigenvalues of A, for the series.
    """

    x: np.ndarray
    volumes: np.ndarray
    make_operator: Callable[[], ConvolutionOperator]
    series: Flow | None = None
    propagator: ConvolutionOperator | None = None
    interval: tuple[float, float] | None = None

    @cached_property
    def operator(self) -> ConvolutionOperator:
        """A. A solve by one lattice sum never needs it."""
        return self.make_operator()

    @property
    def applications(self) -> int:
        """The number of lattice sums that a solve takes."""
        return 1 if self.series is None else self.series.operator_applications

    def apply(self, u: np.ndarray) -> np.ndarray:
        """Return A u."""
        return self.operator.apply(u)

    def solve(self, u0: np.ndarray) -> np.ndarray:
        """Return exp(A t) u0."""
        if self.series is not None:
            return self.series(np.asarray(u0, dtype=float))
        assert self.propagator is not None
        return self.propagator.apply(u0)


def lattice_peer(
    weights: Weights, symbol: Symbol | None = None, squares: Squares | None = None, **facts: Any
) -> Peer:
    """Return a peer on a lattice.

    Parameters
    ----------
    weights : callable
        (alpha, count) -> a_m for m = 0 .. count - 1.
    symbol : callable, optional
        (theta, alpha) -> a(theta), without which there is no convolution in time.
    squares : callable, optional
        The part of one coordinate in the symbol in the plane, see `plane`.
    **facts
        The attributes of the peer that are left.
    """
    return Peer(
        exteriors=("truncated", "open"),
        propagations=("series",) if symbol is None else ("series", "convolution"),
        make=partial(_prepared, weights, symbol),
        make_plane=None if squares is None else partial(truncated_plane, squares),
        **facts,
    )


def _prepared(weights: Weights, symbol: Symbol | None, task: Task) -> LatticeSolver:
    alpha, n = task.alpha, half_intervals(task)
    size, h = 2 * n + 1, task.half_width / n
    last = 4 * n + 1  # M, odd: there a panel of Huang & Oberman's rule ends
    rate = h**-alpha
    amplitude = rate * tail_constant(alpha)

    x, volumes = np.arange(-n, n + 1) * h, np.full(size, h)

    def row() -> np.ndarray:
        return rate * weights(alpha, size if task.exterior == "truncated" else last + 1)

    def operator(a: np.ndarray) -> ConvolutionOperator:
        return tabulated_operator(a, n, alpha, [amplitude], task.exterior)

    if task.propagation == "series":
        a = row()
        made, interval = operator(a), _spectral_interval(a[:size])
        series = exponential_flow(made, task.time, *interval)
        return LatticeSolver(x, volumes, lambda: made, series, interval=interval)
    assert symbol is not None
    tau = task.time * rate

    def amplification(theta: np.ndarray) -> np.ndarray:
        return np.exp(tau * symbol(theta, alpha))

    one_sum = propagator(amplification, alpha, tau, n, task.exterior)
    return LatticeSolver(x, volumes, lambda: operator(row()), propagator=one_sum)


def _spectral_interval(a: np.ndarray) -> tuple[float, float]:
    """Return an interval that holds the eigenvalues of the Toeplitz matrix with the first row a.

    They lie between the least and the largest value of sum_m a_|m| e^(i m theta), whatever a is beyond the row. With
    the infinite row that is the symbol, nowhere positive for any peer: zero is the upper end, with no room above it,
    where the series would be that of a function that grows.
    """
    # Even, so that theta = pi is there.
    length = 2 * next_fast_len(_OVERSAMPLING * a.size // 2, real=True)
    low = float((2.0 * rfft(a, length).real - a[0]).min())
    return low * (1.0 + _MARGIN), 0.0
