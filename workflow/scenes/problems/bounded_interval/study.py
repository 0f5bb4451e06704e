"""An interval: eigenvalues, closed forms and invariants; and what the paper's truncated schemes solve there."""

from collections.abc import Iterator
from typing import Any

import numpy as np
import pandas as pd
from scipy.linalg import eigvalsh, expm
from scipy.special import gamma

from fracparticles.bounded.interval import Interval
from fracparticles.bounded.interval_jacobi import jacobi_eigenvalues
from fracparticles.bounded.interval_no_flux import no_flux_state
from fracparticles.run.orders import observed_order
from fracparticles.schemes.setting import Setting
from fracparticles.schemes.spectrum import scheme_matrix
from fracparticles.variable.closed_forms import Cauchy
from fracstudy.errors import off, three_digits
from fracstudy.inputs import Inputs, Result
from fracstudy.panels import Panels

# Name -> degree p of the map, near neighbours q with a weight.
_MAPS = {"equal volumes, q = 3": (1.0, 3), "p = 4, q = 3": (4.0, 3)}
_MAPS |= {f"p = 8, q = {q}": (8.0, q) for q in range(4)}
_ROUNDING = 1e-13  # errors below are written as that
_LATE = 12.0  # when what is left is the last state
_BUMP = 0.3


def study(
    inputs: Inputs,
    *,
    alphas: list[float],
    drawn: float,
    counts: list[int],
    particles: int,
    halves: list[int],
    overlap: float,
    bump: dict[str, float],
) -> Result:
    """A row for each number that is known."""
    panels = Panels()
    rows = [
        *_eigenvalues(drawn, counts, panels),
        *(row for alpha in alphas for row in _closed_forms(alpha, particles)),
        *_truncated(drawn, halves, overlap, panels),
    ]
    _profiles(drawn, particles, bump, panels)
    known = ["exact", "ours", "error", "order", "of theory"]
    table = pd.DataFrame(rows, columns=["ends", "quantity", "alpha", "particles", *known])
    return Result(table, (), panels.frame)


def _row(
    ends: str, quantity: str, alpha: float, particles: int, error: float, **more: Any
) -> dict[str, Any]:
    row = {"ends": ends, "quantity": quantity, "alpha": alpha, "particles": particles}
    return {**row, "error": three_digits(error), **more}


def _eigenvalues(alpha: float, counts: list[int], panels: Panels) -> Iterator[dict[str, Any]]:
    """The first eigenvalue on each map, against Jacobi polynomials."""
    exact = jacobi_eigenvalues(alpha)[0]
    for name, (degree, near) in _MAPS.items():
        ours = [
            Interval(alpha=alpha, particles=n, degree=degree, near=near).eigenvalues()[0]
            for n in counts
        ]
        errors = np.abs(np.array(ours) / exact - 1.0)
        panels.add("eigenvalue", name, counts, np.maximum(errors, _ROUNDING))
        # The order of the last refinement above round-off.
        last = int(np.flatnonzero(errors > 100.0 * _ROUNDING)[-1])
        between = observed_order([1.0 / n for n in counts], errors)
        orders = {
            "order": float(between[last - 1]),
            "of theory": min(degree, 2.0 * near + 2.0 - alpha),
        }
        yield _row(
            "absorbing", f"first eigenvalue, {name}", alpha, counts[last], errors[last],
            exact=exact, ours=ours[last], **orders,
        )  # fmt: skip


def _closed_forms(alpha: float, particles: int) -> Iterator[dict[str, Any]]:
    """Each kind of end against what is known of it."""
    absorbing, reflecting, given = (
        Interval(alpha=alpha, particles=particles, exterior=exterior)
        for exterior in ("absorbing", "reflecting", "given")
    )
    x = absorbing.x

    def row(ends: str, quantity: str, error: float, **more: Any) -> dict[str, Any]:
        return _row(ends, quantity, alpha, particles, error, **more)

    exact, ours = jacobi_eigenvalues(alpha)[0], absorbing.eigenvalues()[0]
    yield row("absorbing", "first eigenvalue", ours / exact - 1.0, exact=exact, ours=ours)
    middle = particles // 2
    first, second = (absorbing.evolve(1.0, t)[middle] for t in (8.0, 9.0))
    ours = float(np.log(first / second))
    yield row("absorbing", "decay from t = 8 to 9", ours / exact - 1.0, exact=exact, ours=ours)
    rate = float(gamma(1.0 + alpha))
    steady = absorbing.stationary(rate)
    getoor = np.clip(1.0 - x * x, 0.0, None) ** (0.5 * alpha)
    yield row("absorbing", "stationary, f = 1 (Getoor)", off(steady, getoor, 1.0))

    def reaction(x: np.ndarray, t: float, u: np.ndarray) -> np.ndarray:
        exact = np.cos(t) * getoor
        return np.asarray(np.cos(t) * rate - np.sin(t) * getoor + exact**2 - u**2)

    u = absorbing.react(getoor, 1.0, reaction)
    yield row("absorbing", "f = g(x, t) - u^2 at t = 1", off(u, np.cos(1.0) * getoor, 1.0))
    start = np.exp(-20.0 * (x - _BUMP) ** 2)
    mass = reflecting.total(start)
    after = reflecting.evolve(start, 0.1)
    yield row("reflecting", "mass at t = 0.1", reflecting.total(after) / mass - 1.0)
    yield row("reflecting", "a constant at t = 0.1", off(reflecting.evolve(1.0, 0.1), 1.0))
    bell, source = Cauchy.value([x]), Cauchy.riesz([x], alpha)
    u = given.evolve(
        bell,
        1.0,
        source=lambda x, t: np.cos(t) * source - np.sin(t) * bell,
        outside=lambda y, t: np.cos(t) * Cauchy.value([y]),
    )
    yield row("given", "cos(t) / (1 + x^2) at t = 1", off(u, np.cos(1.0) * bell, 1.0))
    held = given.evolve(1.0, 0.1, outside=1.0)
    yield row("given", "a constant at t = 0.1", off(held, 1.0))


def _truncated(
    alpha: float, halves: list[int], overlap: float, panels: Panels
) -> Iterator[dict[str, Any]]:
    """The paper's schemes on a lattice that ends at -1 and 1: which problem they come to solve."""
    absorbing = jacobi_eigenvalues(alpha)[0]
    reflecting = Interval(alpha=alpha, particles=400, exterior="reflecting").eigenvalues(2)[1]
    level = float(no_flux_state(np.zeros(1), alpha)[0])
    known = {
        "DD": ("absorbing", "first eigenvalue", absorbing, lambda a, h: eigvalsh(-a)[0]),
        "KPSE": ("reflecting", "second eigenvalue", reflecting, lambda a, h: eigvalsh(-a)[1]),
        "DPSE": ("no flux", "last state at x = 0", level, _last_level),
        "FPSE": ("no flux", "last state at x = 0", level, _last_level),
    }
    for name, (ends, quantity, exact, measured) in known.items():
        spacings = np.array([2.0 / (2 * n + 1) for n in halves])
        ours = []
        for n, h in zip(halves, spacings, strict=True):
            setting = Setting(alpha=alpha, overlap=overlap, n=n, spacing=h)
            ours.append(measured(scheme_matrix(name, setting), h))
        errors = np.abs(np.array(ours) / exact - 1.0)
        panels.add("truncated", name, spacings, errors, ends=ends)
        order = float(observed_order(spacings, errors)[-1])
        yield _row(
            ends, f"{name}, {quantity}", alpha, 2 * halves[-1] + 1, errors[-1],
            exact=exact, ours=ours[-1], order=order,
        )  # fmt: skip


def _last_level(matrix: np.ndarray, h: float) -> float:
    """u(0) per mass after a long time, from a bell."""
    n = len(matrix) // 2
    start = np.exp(-8.0 * (h * np.arange(-n, n + 1)) ** 2)
    return float((expm(_LATE * matrix) @ start)[n] / (h * start.sum()))


def _profiles(alpha: float, particles: int, bump: dict[str, float], panels: Panels) -> None:
    """A bump, after a time, with each kind of end; and where FPSE ends."""
    for exterior in ("absorbing", "reflecting", "given"):
        line = Interval(alpha=alpha, particles=particles, exterior=exterior)
        start = np.exp(-20.0 * (line.x - _BUMP) ** 2)
        outside = bump["outside"] if exterior == "given" else None
        u = line.evolve(start, bump["time"], outside=outside)
        panels.add("profile", exterior, line.x, u)
    inner = line.x[np.abs(line.x) < 0.995]
    mass = line.total(start)
    panels.add("profile", "no flux, final state", inner, no_flux_state(inner, alpha, mass))
