"""Sums over lattices of any size, and the matrices of the schemes, against sums term by term."""

from collections.abc import Iterator
from functools import cache
from itertools import product
from typing import Any

import numpy as np

from fracparticles.lattice.banded import BandedConvolution
from fracparticles.lattice.box import BoxConvolution, NaiveBoxConvolution
from fracparticles.lattice.direct import MatrixConvolution, NaiveConvolution
from fracparticles.lattice.exterior import far_field
from fracparticles.lattice.fourier import FourierConvolution
from fracparticles.schemes import SCHEMES, Setting
from fracparticles.schemes.base import LatticeScheme
from fracparticles.schemes.spectrum import scheme_matrix
from fracstudy.probe import EPS, HELD, REFUSED, Kind, Probe, off
from scenes.extremes.geometry.printed import Kernels, matrix, places, power_sum

_KERNELS = 1e-11  # the accuracy that `kernels.kernel` promises
_LINE: dict[str, Any] = {
    "fft": FourierConvolution,
    "naive": NaiveConvolution,
    "matrix": MatrixConvolution,
}
_BOX: dict[str, Any] = {"fft": BoxConvolution, "naive": NaiveBoxConvolution}


def _rounding(terms: int) -> float:
    """Of a sum over so many terms, against sum |w| max |u|: one rounding a term, and those of three transforms.

    A transform of length L leaves some log2 L roundings (Higham 2002, Sec. 24.1), of at most 4 N here.
    """
    return EPS * (terms + 8.0 * np.log2(4.0 * terms))


def lattice_sums(sizes: dict[str, list[int]], half: dict[int, list[int]]) -> Iterator[Probe]:
    """y_i = sum_j w_{i-j} u_j of random numbers, by each summation, on lattices of every kind of size.

    Also beyond the ends of the lattice, up to seven points; w even and odd.
    """
    right = Kind("sums", "the sum term by term", source="numpy, dense", must=HELD)
    for kind, some in sizes.items():
        every, most = f"N {kind}: {', '.join(map(str, some))}", max(some)
        for name, one in _LINE.items():
            worst = lambda: max(_of_line(one, size) for size in some)
            yield right(f"line, {name}, {every}", worst, bound=_rounding(most))
        worst = lambda: max(map(_of_band, some))
        yield right(f"line, banded, {every}, bands up to N", worst, bound=_rounding(2 * most))
    for dim, (name, one) in product([d for d in half if d > 1], _BOX.items()):
        larger = [(7, 7), (3, 9), (9, 5)] if dim == 3 else [(13, 13), (5, 19), (17, 11)]
        sides = [(1, 1), (3, 3), *larger]
        yield right(
            f"n = {dim}, {name}, from S^n to T^n: {', '.join(f'{a}-{b}' for a, b in sides)}",
            lambda: max(_of_box(one, dim, *pair) for pair in sides),
            bound=_rounding(19**dim),
        )


def _missed(
    found: np.ndarray, apart: np.ndarray, parity: int, w: np.ndarray, u: np.ndarray
) -> float:
    """How far a sum of w_{|i-j|} u_j, odd or even in i - j, is from the one by its matrix."""
    exact = (np.where(apart < 0, parity, 1) * w[np.abs(apart)]) @ u
    return off(found, exact, _size(w, u))


def _of_line(convolution: Any, size: int) -> float:
    rng, worst = np.random.default_rng(size), 0.0
    for pad, parity in ((0, 1), (0, -1), (1, 1), (7, -1)):
        w, u = rng.standard_normal(size + pad), rng.standard_normal(size)
        w[0] *= parity > 0
        apart = np.arange(-pad, size + pad)[:, None] - np.arange(size)
        found = convolution(w, size, parity, pad)(u)
        worst = max(worst, _missed(found, apart, parity, w, u))
    return worst


def _of_band(size: int) -> float:
    rng, worst = np.random.default_rng(size), 0.0
    for band, parity in ((0, 1), (1, -1), (4, 1), (size, -1), (2 * size, 1)):
        w, v = rng.standard_normal(band + 1), rng.standard_normal(size)
        w[0] *= parity > 0
        apart = np.arange(size)[:, None] - np.arange(size)
        found = BandedConvolution(w, parity)(v, np.empty(size))
        worst = max(worst, _missed(found, apart, parity, np.append(w, np.zeros(size)), v))
    return worst


def _of_box(convolution: Any, dim: int, sources: int, targets: int) -> float:
    rng, worst, half = np.random.default_rng(sources + targets), 0.0, (sources + targets) // 2
    for odd in (None, *range(dim)):
        w, u = rng.standard_normal((half,) * dim), rng.standard_normal((sources,) * dim)
        if odd is not None:
            w[(slice(None),) * odd + (0,)] = 0.0
        apart = places(targets // 2, dim)[:, None] - places(sources // 2, dim)
        signs = 1.0 if odd is None else np.where(apart[..., odd] < 0, -1.0, 1.0)
        exact = (signs * w[tuple(np.moveaxis(np.abs(apart), -1, 0))]) @ u.reshape(-1)
        found = convolution([w], [odd], sources, targets)(u)[0].reshape(-1)
        worst = max(worst, off(found, exact, _size(w, u)))
    return worst


def _size(w: np.ndarray, u: np.ndarray) -> float:
    return float(np.abs(w).sum() * np.abs(u).max()) or 1.0


def matrices(
    beta: float, orders: list[int], overlaps: list[float], half: dict[int, list[int]]
) -> Iterator[Probe]:
    """A of each scheme against the printed formula, entry by entry; lattices of one particle a side and more.

    `half` has, by dimension, half the intervals of the lattices. The deviation is that of the greatest sum of a row.
    """
    # An entry is the sum of N others in FPSE and DPSE, whose kernels cancel by some ten.
    right = Kind("matrix", "the printed formula, entry by entry", _KERNELS, must=HELD)
    for name, one in SCHEMES.items():
        source = "mpmath, dense" if name != "GPSE" else "QUADPACK, dense"
        for dim, overlap in product([d for d in one.dims if d in half], overlaps):
            counts = ", ".join(str((2 * n + 1) ** dim) for n in half[dim])
            case = f"{name}, n = {dim}, overlap {overlap:g}, N = {counts}"
            how = (one, beta, dim, orders, overlap, half[dim])
            yield right(case, _of_matrices, *how, source=source)


def _of_matrices(
    one: LatticeScheme, beta: float, dim: int, orders: list[int], overlap: float, half: list[int]
) -> float:
    worst = 0.0
    for order in [r for r in orders if r in (one.orders if dim == 1 else one.box_orders)]:
        kernels = Kernels(1.0 + beta, dim, order, "gamma" if order > 4 else "printed")
        shared: dict[str, Any] = {
            "alpha": 1.0 + beta,
            "order": order,
            "overlap": overlap,
            "dim": dim,
        }
        for n in half:
            exact = matrix(one.name, kernels, n, overlap)
            for summation in ("fft", "naive"):
                found = scheme_matrix(one.name, Setting(**shared, n=n, summation=summation))
                difference, size = (np.abs(a).sum(axis=1).max() for a in (found - exact, exact))
                worst = max(worst, float(difference / size) if size else float(difference))
    return worst


def exteriors(beta: float, overlaps: list[float], beyond: list[int]) -> Iterator[Probe]:
    """The sums beyond the ends of the line, S_i = sum_{j > n} (n / j)^(1+alpha) w_{i-j}, term by term and an integral.

    The library sums f = j^-(1+alpha) w_{i-j} to 4 n, and from there by the formula of Euler and Maclaurin, whose next
    term is 7 f''' / 5760: for f ~ y^-5 and y >= 3 n that is (3 n)^-4 of the sum.
    """
    alpha, power = 1.0 + beta, 1.0 + (1.0 + beta)
    for n, overlap in product(beyond, overlaps):
        right = Kind("exterior", "the sum to infinity", (3.0 * n) ** -4.0, "mpmath, QUADPACK")
        yield right(f"KPSE's kernel, n = {n}, overlap {overlap:g}", _of_exterior, alpha, n, overlap)
    refused = Kind("exterior", "refused: too few particles to fit", must=REFUSED)
    for n, terms in ((0, 1), (1, 2), (2, 3)):
        tail = lambda: far_field(lambda m: np.abs(m) ** -power, power, alpha, n, terms=terms)
        yield refused(f"N = {2 * n + 1}, terms: {terms}", tail)


@cache
def _weight(alpha: float, r: float) -> float:
    """K(r), which takes long by mpmath and is asked for again by both ends of every line."""
    return Kernels(alpha).values("K", r)


def _of_exterior(alpha: float, n: int, overlap: float) -> float:
    weight = lambda m: _weight(alpha, abs(m) / overlap)
    found, far = far_field(np.vectorize(weight), 1.0 + alpha, alpha, n).right[0], max(200, 10 * n)
    size = float(np.abs(found).max())
    exact = {i: power_sum(weight, 1.0 + alpha, n, i, far=far) for i in (-n, 0, n)}
    return max(abs(float(found[i + n]) - value) / size for i, value in exact.items())
