"""Signs, bounds and totals: what the weights of a scheme say of any data, however rough; and one point's spreading."""

from collections.abc import Callable, Iterator

import numpy as np

from fracparticles.run.case import Case
from fracparticles.schemes import SCHEMES
from fracparticles.schemes.spectrum import scheme_matrix
from fracparticles.special.stable import green
from fracparticles.time.whole_space import evolve
from fracstudy.probe import WARNED, Kind, Probe
from scenes.extremes.geometry.lattices import OF_A_FUNCTION
from scenes.extremes.rough_data.cases import case_of, cases_of, point, run

_ROUNDED = 1e-13
_KERNELS = [("KPSE", 2, 0.5), ("KPSE", 4, 0.5), ("KPSE", 4, 0.9), ("KPSE", 12, 0.5)]
_KERNELS += [(scheme, 2, 0.5) for scheme in ("GPSE", "FD", "DD", "FPSE")]


def signs() -> Iterator[Probe]:
    """One particle for so short a time that u = u0 + T A u0: the sign of the weights, which the printed kernels give.

    K of order II is positive, that of order IV for beta = 0.9 not; G and the flux are not. A scheme with negative
    weights makes negative strengths: that is not an error of the code, and u says so.
    """
    for scheme, order, beta in _KERNELS:
        # GPSE takes no short steps: they are its smoothing length.
        short = {} if scheme == "GPSE" else {"t_final": 1e-5}
        case = case_of(scheme, beta, order=order, **short)
        a = scheme_matrix(case.scheme, case.setting)
        least = float((a - np.diag(np.diag(a)) + np.diag(np.full(len(a), np.inf))).min())
        positive = least >= 0.0
        expected = "stays positive" if positive else "turns negative"
        name = f"{scheme}, order {order}, beta = {beta:g}, one particle"
        yield Kind("sign", expected, source="weights of the matrix")(name, _sign, case, positive)


def _sign(case: Case, positive: bool) -> tuple[float, str]:
    u = run(case, point(case))
    least = float(u.min() / u.max())
    return float((least >= -_ROUNDED) != positive), f"least u {least:.1e} of the peak"


def bounds(beta: float, dims: list[int]) -> Iterator[Probe]:
    """Schemes with positive weights keep to the bounds of the data, both the greatest and the least, and their total.

    KPSE and GPSE, order II: A has no negative weight off the diagonal and A 1 = 0, so that exp(A T) is a mean.
    """
    rng = np.random.default_rng(11)
    within = Kind("bounds", "within the bounds of the data", _ROUNDED, "maximum principle")
    total = Kind("total", "the total of the data", _ROUNDED, "closed form")
    for scheme in ("KPSE", "GPSE"):
        for dim in dims:
            plain = {} if dim == 1 else {"half_width": 4.0, "spacing": 0.5}
            case = case_of(scheme, beta, dim=dim, **plain)
            for words, u0 in {
                "noise in [-1, 1]": rng.uniform(-1.0, 1.0, case.shape),
                "zeros and ones": rng.integers(0, 2, case.shape).astype(float),
                "one point": point(case),
                "one point at a corner": point(case, 0),
            }.items():
                yield within(f"{scheme}, n = {dim}, {words}", _beyond, case, u0)
                yield total(
                    f"{scheme}, n = {dim}, {words}",
                    lambda: float(abs(run(case, u0).sum() - u0.sum()) / np.abs(u0).sum()),
                )


def _beyond(case: Case, u0: np.ndarray) -> float:
    u = run(case, u0)
    return float(max(u.max() - u0.max(), u0.min() - u.min(), 0.0) / np.abs(u0).max())


def point_masses(beta: float, half_width: float) -> Iterator[Probe]:
    """All strength on one particle: the wave (-1)^i of two particles decays by the symbol; KPSE still converges.

    The transforms of G, F and eta1 are almost zero at theta = k h = pi: DD and FPSE hardly damp that wave. From rough
    data it is the strengths, not the scheme's smooth part, that stay wrong, and the library must say that.
    """
    for scheme in ("DD", "FPSE", "KPSE"):
        case = case_of(scheme, beta, half_width=half_width, spacing=0.05)
        symbol = float(SCHEMES[scheme].symbol(np.array([np.pi]), case.setting)[0])
        predicted = float(np.exp(symbol * case.setting.rate * case.span))
        # of the wave: the ends of the lattice reflect some of it
        bound, expected = 0.02, f"keeps {predicted:.2f} of its amplitude"
        wave = Kind("wave of two", expected, bound, "Fourier symbol", WARNED)
        yield wave(f"{scheme}, one particle, T = 0.5, h = 0.05", _wave, case, predicted)
    spreads = Kind("point mass", "the fundamental solution", 1.0, "closed form")
    given = {"exterior": "open", "t_final": 1.0}
    kpse, gpse = (
        [case_of(scheme, beta, half_width=half_width, spacing=h, **given) for h in (0.1, 0.05)]
        for scheme in ("KPSE", "GPSE")
    )
    falls = f"{spreads.expected}, error falls 4 times"
    yield spreads("KPSE, h = 0.1 and 0.05, open", _falls_fourfold, kpse, expected=falls)
    yield spreads("GPSE, h = 0.1 and 0.05, open", _exact, gpse)
    for n, h in ((2, 0.5), (3, 0.75)):
        case = case_of("GPSE", beta, dim=n, half_width=6.0, spacing=h, **given)
        # The open exterior continues the data by nothing; what is left is the particle's own share,
        # 1 - sum_j V E_j for V E_0, the error of the quadrature: exp(-(2 pi / h)^alpha T).
        yield spreads(f"GPSE, n = {n}, one step, open", _error, case, bound=1e-6)


def functions(beta: float, schemes: list[str]) -> Iterator[Probe]:
    """Rough functions, against `evolve` on a lattice eight times as fine and four times as wide: right, or spoken of.

    What the estimates let pass: 0.05 of a wave, 0.05 beyond the lattice and 0.05 between the particles, each of them
    missing in one place and found in another.
    """
    right = Kind("function", "the solution on a fine lattice", OF_A_FUNCTION, "evolve")
    for case in cases_of(beta, schemes, half_width=20.0):
        for words, u in _ROUGH.items():
            yield right(f"{case.scheme}, {case.exterior}, {words}, h = 0.25", _of_function, case, u)


_ROUGH: dict[str, Callable[[np.ndarray], np.ndarray]] = {
    "a box of 24 particles": lambda x: np.where(np.abs(x) < 3.05, 1.0, 0.0),
    "a box of 3 particles": lambda x: np.where(np.abs(x) < 0.3, 1.0, 0.0),
    "a hat of 16 particles": lambda x: np.maximum(0.0, 1.0 - np.abs(x) / 2.0),
    "a spike of a tenth of h": lambda x: np.exp(-((x / 0.025) ** 2)),
    "the same between two": lambda x: np.exp(-(((x - 0.125) / 0.025) ** 2)),
    "one between two, beside smooth": lambda x: (
        np.exp(-x * x) + 30.0 * np.exp(-(((x - 5.125) / 0.05) ** 2))
    ),
    "waves of 2.2 h": lambda x: np.exp(-x * x / 16.0) * np.cos(2.0 * np.pi / 0.55 * x),
    "waves of 1.1 h": lambda x: np.exp(-x * x / 16.0) * np.cos(2.0 * np.pi / 0.275 * x),
    "waves of 12 h, both signs": lambda x: np.exp(-x * x / 16.0) * np.sin(2.0 * np.pi / 3.0 * x),
    "a step at the edge": lambda x: np.where(x > 19.0, 1.0, 0.0),
}


def _of_function(case: Case, u: Callable[[np.ndarray], np.ndarray]) -> float:
    fine, h = 4 * 8 * case.n, case.particle_spacing / 8.0
    every = np.arange(-fine, fine + 1) * h
    exact = evolve(u(every), h, case.alpha, case.span, tail=())[
        fine - 8 * case.n : fine + 8 * case.n + 1 : 8
    ]
    return float(np.abs(run(case, u) - exact).sum() / np.abs(exact).sum())


def _wave(case: Case, predicted: float) -> tuple[float, str]:
    u0 = point(case)
    u = run(case, u0)
    wave = (-1.0) ** np.arange(u.size)
    found = float(wave @ u / (wave @ u0))
    return abs(found - predicted), f"{found:.2f}"


def _error(case: Case) -> float:
    exact = np.asarray(green(case.radius, case.span, case.alpha, case.dim))
    return float(np.abs(run(case, point(case)) - exact).sum() / exact.sum())


def _falls_fourfold(cases: list[Case]) -> tuple[float, str]:
    coarse, fine = map(_error, cases)
    return abs(coarse / fine - 4.0) / 0.4, f"{coarse:.0e} to {fine:.0e}"


def _exact(cases: list[Case]) -> tuple[float, str]:
    coarse, fine = map(_error, cases)
    return coarse / 1e-9, f"{coarse:.0e} to {fine:.0e}"
