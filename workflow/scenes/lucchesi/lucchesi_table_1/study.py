"""Table 1: the schemes, each held against the paper's own sum over all pairs of particles."""

from collections.abc import Callable
from math import cos, gamma, pi
from typing import Any

import numpy as np
import pandas as pd

from fracparticles.kernels.families import kernel
from fracparticles.moving.dvm import DiffusionVelocity
from fracparticles.run.orders import observed_order
from fracparticles.schemes import ALL_SCHEMES, SCHEMES, Scheme, Setting, riesz
from fracparticles.schemes.spectrum import scheme_matrix
from fracparticles.special.stable import green
from fracstudy.errors import EPS, off
from fracstudy.findings import each, measured
from fracstudy.inputs import ORDERS, Inputs, Result
from scenes.lucchesi.lucchesi_table_1.extension import variable_diffusivity

# A sum of N terms, of which the largest are some 1e3 times the result: N 1e3 roundings of 1e-16.
_ROUND_OFF = 1e-11
_WAVES = 0.025 * 0.5 ** np.arange(4)  # k h at which its order is measured


def _scaled(name: str, r: np.ndarray, s: Setting) -> np.ndarray:
    """K_epsilon(r) = K(r / epsilon) / epsilon, n = 1."""
    return np.asarray(kernel(name, r / _epsilon(s), s.alpha, order=s.order)) / _epsilon(s)


def _epsilon(s: Setting) -> float:
    return s.overlap * s.spacing


def _sum(u: np.ndarray, k: np.ndarray, s: Setting, power: float) -> np.ndarray:
    """sum_j V_j u_j k_ij / epsilon^power."""
    return (s.spacing * u * k).sum(axis=1) / _epsilon(s) ** power


def _exchange(u: np.ndarray, k: np.ndarray, s: Setting, power: float) -> np.ndarray:
    """sum_j V_j (u_j - u_i) k_ij / epsilon^power."""
    return _sum(u[None, :] - u[:, None], k, s, power)


def _flux(u: np.ndarray, r: np.ndarray, s: Setting) -> np.ndarray:
    """(25) with the flux (19)."""
    q = -_sum(u, _scaled("F", r, s), s, s.alpha - 1.0)
    return -_sum(q[None, :] + q[:, None], _scaled("eta1", r, s), s, 1.0)


def _dpse(u: np.ndarray, r: np.ndarray, s: Setting) -> np.ndarray:
    """(16): (2 / epsilon^2) sum_j V_j (v_j - v_i) Phi_epsilon(x_j - x_i) with the potential (13)."""
    v = _sum(u, _scaled("kappa", r, s), s, s.alpha - 2.0)
    return 2.0 * _exchange(v, _scaled("Phi", -r, s), s, 2.0)


def _riesz(u: np.ndarray, r: np.ndarray, s: Setting) -> np.ndarray:
    """As (34), with the kernel K* of the regularised potential."""
    k = riesz.kernel_star(r / _epsilon(s), s.alpha) / _epsilon(s)
    return s.alpha * _exchange(u, k, s, s.alpha)


def _finite_differences(u: np.ndarray, r: np.ndarray, s: Setting) -> np.ndarray:
    """The one-sided sums L_i and R_i of `schemes.fd`, term by term, with u = 0 beyond the ends."""
    h, beta = s.spacing, s.alpha - 1.0
    padded = np.concatenate([np.zeros(2), u, np.zeros(2)])  # u_j at index j + 2, j = -2 .. N + 1
    delta = np.diff(padded) / h  # delta_j = (u_j - u_{j-1}) / h at index j + 1

    def omega(z: float) -> float:
        return z ** (1.0 - beta) / gamma(2.0 - beta)

    def left(i: int) -> float:
        steps = (omega((i - j + 1) * h) - omega((i - j) * h) for j in range(i + 1))
        return sum(step * delta[j + 1] for j, step in enumerate(steps))

    def right(i: int) -> float:
        steps = (omega((j - i) * h) - omega((j - 1 - i) * h) for j in range(i + 1, u.size + 1))
        return sum(step * delta[j + 1] for j, step in enumerate(steps, start=i + 1))

    flux = [left(i + 1) - left(i) + right(i) - right(i - 1) for i in range(u.size)]
    return np.array(flux) / (2.0 * h * abs(cos(0.5 * pi * s.alpha)))


PAIR_SUMS: dict[str, Callable[[np.ndarray, np.ndarray, Setting], np.ndarray]] = {
    # (10): (1 / epsilon^alpha) sum_j V_j u_j G_epsilon(x_i - x_j)
    "DD": lambda u, r, s: _sum(u, _scaled("G", r, s), s, s.alpha),
    "FPSE": _flux,
    # (34): (alpha / epsilon^alpha) sum_j V_j (u_j - u_i) K_epsilon(x_j - x_i)
    "KPSE": lambda u, r, s: s.alpha * _exchange(u, _scaled("K", -r, s), s, s.alpha),
    # (41): (1 / epsilon^alpha) sum_j V_j (u_j - u_i) E_epsilon(x_j - x_i)
    "GPSE": lambda u, r, s: _exchange(u, _scaled("E", -r, s), s, s.alpha),
    "FD": _finite_differences,
    "DPSE": _dpse,
    # (29): (1 / epsilon^alpha) sum_j V_j (u_j - u_i) G_epsilon(x_j - x_i)
    "PSE29": lambda u, r, s: _exchange(u, _scaled("G", -r, s), s, s.alpha),
    "RIESZ": _riesz,
}
"""By scheme: du/dt from strengths u, distances r[i, j] = x_i - x_j and a setting (D = 1)."""


def diffusion_velocity(x: np.ndarray, strength: np.ndarray, s: Setting) -> np.ndarray:
    """(44): v_i = Q(x_i) / u(x_i), u by (45) and Q by (19), both summed over all pairs."""
    r = x[:, None] - x[None, :]
    u = (strength * _scaled("eta", r, s)).sum(axis=1)
    return -(strength * _scaled("F", r, s)).sum(axis=1) / _epsilon(s) ** (s.alpha - 1.0) / u


def study(
    inputs: Inputs, *, beta: list[float], particles: int, spacing: float, variable: dict[str, Any]
) -> Result:
    """List the schemes; compare each operator with its sum over all pairs, for random strengths on a lattice.

    The scheme of Ref. [41] is not printed: what is measured there is the order of our reconstruction, from its symbol.
    """
    schemes = {**SCHEMES, "DVM": ALL_SCHEMES["DVM"]}

    def setting(b: float, order: int = 2) -> Setting:
        return Setting(n=particles // 2, spacing=spacing, alpha=1.0 + b, order=order)

    worst = {
        name: max(_difference(name, setting(b, order)) for b in beta for order in _orders(scheme))
        for name, scheme in schemes.items()
    }
    rows = [_row(scheme, worst[name] <= _ROUND_OFF) for name, scheme in schemes.items()]
    velocity = each(lambda b: abs(velocity_order(1.0 + b) - 2.0), beta=beta)
    consistency = each(lambda b: consistency_order(1.0 + b), beta=beta)
    excess = _localised_pairs() - 1.0
    localised = {"the divergence localised to nearby particles, as Sec. 6 says": {"excess": excess}}
    findings = [
        *(measured(f"L-T1.{s}", difference=worst[s]) for s in ("DD", "FPSE", "KPSE", "GPSE")),
        measured("L-T1.DVM", difference=worst["DVM"], order=velocity),
        measured("L-T1.FD", order=consistency, difference=worst["FD"]),
        *(
            measured(
                f"L-COST.{s}",
                defect=each(lambda b, s=s: _toeplitz_defect(s, setting(b)), beta=beta),
            )
            for s in ("DD", "KPSE", "GPSE", "DPSE", "FPSE")
        ),
        # two sums over all pairs for one
        measured("L-COST.cheaper", others=localised, excess=1.0, localised=excess),
        *variable_diffusivity(**variable),
    ]
    return Result(pd.DataFrame(rows), inputs.judged(findings))


def _orders(scheme: Scheme) -> list[int]:
    """The orders of the paper that the scheme has."""
    return [order for order in ORDERS if order in scheme.orders]


def _row(scheme: Scheme, equal: bool) -> dict[str, str]:
    return {
        "referred": scheme.name,
        "scheme": scheme.title,
        "method": scheme.equation,
        "kernel": scheme.kernel,
        "order": ", ".join(ORDERS[order] for order in _orders(scheme)),
        "conservative": "yes" if scheme.conservative else "no",
        "exterior": ", ".join(scheme.exteriors),
        "equals the sum over pairs": "yes" if equal else "no",
    }


def _difference(name: str, s: Setting) -> float:
    """The operator against the sum, for DVM the velocity, at particles up to 0.4 h off the lattice; relative."""
    random, i = np.random.default_rng(1), np.arange(-s.n, s.n + 1)
    if name == "DVM":
        x = s.spacing * (i + random.uniform(-0.4, 0.4, i.size))
        strength = s.spacing / (1.0 + x**2)
        ours = DiffusionVelocity(s.alpha, s.order, s.overlap * s.spacing)(x, strength)
        sums = diffusion_velocity(x, strength, s)
    else:
        u = random.standard_normal(i.size)
        ours = SCHEMES[name].operator(s).apply(u)
        sums = PAIR_SUMS[name](u, (i[:, None] - i[None, :]) * s.spacing, s)
    return off(ours, sums)


def velocity_order(alpha: float) -> float:
    """Return the order in h of the velocity (44) of the fundamental solution at t = 1, exactly x / alpha, |x| <= 3."""
    spacings, errors = np.array([0.1, 0.05]), []
    for h in spacings:
        x = h * np.arange(-round(60.0 / h), round(60.0 / h) + 1)
        velocity = DiffusionVelocity(alpha, 2, 2.0 * h)(x, h * np.asarray(green(x, 1.0, alpha)))
        errors.append(np.abs(velocity - x / alpha)[np.abs(x) <= 3.0].max())
    return float(observed_order(spacings, np.array(errors))[0])


def consistency_order(alpha: float) -> float:
    """Return the lowest order p of FD, symbol(k h) + (k h)^alpha ~ (k h)^(alpha + p), between two waves."""
    exact = _WAVES**alpha
    defect = np.abs(SCHEMES["FD"].symbol(_WAVES, Setting(alpha=alpha)) + exact) / exact
    return float(observed_order(_WAVES, defect).min())


def _toeplitz_defect(name: str, s: Setting) -> float:
    """The largest change of the matrix along its diagonals, but for the main one, over its largest entry there.

    It is zero exactly if the rate of change is one convolution sum and a multiple of u_i.
    """
    a = scheme_matrix(name, s)
    np.fill_diagonal(a, 0.0)
    change = a[1:, 1:] - a[:-1, :-1]
    return float(np.abs(change).max() / np.abs(a).max())


def _localised_pairs() -> float:
    """Pairs of particles that FPSE's two sums need in the reference case, over those of KPSE's one.

    Those are left out whose weight is below round-off of the largest, that is, the far ones of the divergence.
    """
    r = np.arange(-64000, 64001) / 2.0

    def pairs(name: str) -> int:
        weights = np.abs(kernel(name, r, 1.5))
        return int(np.count_nonzero(weights > EPS * weights.max()))

    return (pairs("F") + pairs("eta1")) / pairs("K")
