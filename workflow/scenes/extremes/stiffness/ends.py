"""What is left at the end of a stiff run, and what is said or refused."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import mpmath as mp
import numpy as np

from fracparticles.errors import NonFiniteSolution
from fracparticles.run.case import Case
from fracparticles.run.solver import compute, prepare
from fracparticles.time.rkc import ChebyshevStep, stages_for
from fracstudy.probe import HELD, REFUSED, WARNED, Kind, Probe
from scenes.extremes.stiffness.ways import exact_modes, stiff

__all__ = ["at_the_limit", "conservation", "decay", "refused", "spoken_of"]


def conservation(half: int, stiffness: list[float], most: float) -> Iterator[Probe]:
    """The mass of the exchange schemes, and of KPSE, whose matrix is symmetric, the end: the mean everywhere."""
    mass = Kind("mass", "that of the data", source="closed form", must=HELD)
    the_end = Kind("the end", "the mean of the data everywhere", source="closed form", must=HELD)
    for scheme in ("KPSE", "FPSE", "DPSE"):
        one = stiff(scheme, half)
        for value in stiffness:
            if scheme != "KPSE" and value > 1e7:
                continue
            case = one.case(integrator="exponential", t_final=value / -one.lowest)
            yield mass(
                f"{scheme}, exponential, T |lambda| = {value:.0e}",
                lambda case=case, u0=one.u0: abs(prepare(case).solve(u0).sum() / u0.sum() - 1.0),
                bound=one.bound(value),
            )
            if scheme == "KPSE" and value >= 1e6:
                yield the_end(
                    f"KPSE, exponential, T |lambda| = {value:.0e}",
                    lambda case=case, u0=one.u0: np.abs(
                        prepare(case).solve(u0) / u0.mean() - 1.0
                    ).max(),
                    bound=one.bound(value),
                )


def decay(schemes: list[str], half: int, stiffness: list[float]) -> Iterator[Probe]:
    """Where the ends absorb, u falls below every number: it is zero then, from data of every size, and nobody waits.

    Data of 1e-290 decay as those of one do, with the same digits, down to the smallest number.
    """
    row = Kind("decay", "that of its modes, or zero", source="mpmath", must=HELD)
    for scheme in (name for name in ("DD", "FD") if name in schemes):
        one = stiff(scheme, half)
        of = exact_modes(one)
        for value in stiffness:
            if value > 1e9:
                continue
            time = value / -one.lowest
            for size in (1.0, 1e-250, 1e250):
                case = one.case(integrator="exponential", t_final=time)
                # so many pieces, each to 1e-10
                yield row(
                    f"{scheme}, u of {size:.0e}, T |lambda| = {value:.0e}",
                    lambda case=case, s=size, t=time, one=one, of=of: _decayed(
                        prepare(case).solve(s * one.u0), s, of(lambda z: mp.exp(z * t))
                    ),
                    bound=one.bound(value) + 1e-9,
                )


def at_the_limit(half: int, stiffness: list[float]) -> Iterator[Probe]:
    """Series of so many steps, of the limit itself and of a millionth: p(A dt)^n in forty digits.

    A step at the limit hardly damps the shortest wave; the series may amplify what is beyond by two, over the run.
    """
    stages = {"euler": 1, "rk2": 2, "rk4": 4}
    one = stiff("KPSE", half)
    of = exact_modes(one)
    many_steps = Kind("many steps", source="mpmath", must=HELD)
    for integrator, count in stages.items():
        limit = one.case(integrator=integrator, dt=1.0).largest_stable_step
        for share in (1e-6, 1.0 - 1e-8):  # n steps may come out as n (1 - 1e-9)
            for value in stiffness if share > 0.5 else stiffness[:-1]:
                dt = share * limit
                steps = max(2, int(value / -one.lowest / dt))
                fields = {"integrator": integrator, "dt": dt, "t_final": steps * dt}
                case = one.case(**fields, evaluation="series")

                def power(z: Any, case: Case = case, count: int = count) -> Any:
                    z = z * mp.mpf(case.time_step)
                    return sum(z**k / mp.factorial(k) for k in range(count + 1)) ** case.steps

                # of rk4 the polynomial is steeper at the limit than the exponential anywhere
                yield many_steps(
                    f"KPSE, {integrator}, dt = {share:g} a, T |lambda| = {value:.0e}",
                    lambda case=case, power=power: _relative(
                        prepare(case).solve(one.u0), of(power)
                    ),
                    expected=f"p(A dt)^n, n = {case.steps:.0e}",
                    bound=10.0 * one.bound(value),
                )


def spoken_of(half: int, stiffness: list[float]) -> Iterator[Probe]:
    """T |lambda| so large that round-off matters: a warning, and the error within what it says, 64 T |lambda| eps."""
    one = stiff("KPSE", half)
    a_word = Kind(
        "a word", "the mean, and a warning of the round-off", source="closed form", must=WARNED
    )
    for value in sorted({1e8, max(1e8, *stiffness)}):
        case = one.case(integrator="exponential", t_final=value / -one.lowest)
        yield a_word(
            f"KPSE, exponential, T |lambda| = {value:.0e}",
            lambda case=case, u0=one.u0: np.abs(compute(case, u0).u / u0.mean() - 1.0).max(),
            bound=one.bound(value),
        )


def refused(half: int) -> Iterator[Probe]:
    """Runs that would take too long, steps that are too many, stages beyond the last."""
    kpse, fpse = stiff("KPSE", half), stiff("FPSE", half)
    one = ChebyshevStep(5)
    tries: dict[str, Callable[[], Any]] = {
        "T |lambda| = 1e13": lambda: prepare(kpse.case(integrator="exponential", t_final=1e13)),
        "FPSE, T |lambda| = 1e11": lambda: prepare(
            fpse.case(integrator="exponential", t_final=1e11 / -fpse.lowest)
        ),
        "1e17 steps": lambda: kpse.case(integrator="rk2", dt=1e-17, t_final=1.0),
        "a stabilised step of z = 5e4": lambda: stages_for(5e4),
        "251 stages": lambda: ChebyshevStep(251),
        "rates of another shape": lambda: one.advance(
            lambda y: y[:-1], np.ones(3), dt=1.0, steps=1
        ),
        "data that are nan": lambda: one.advance(
            lambda y: -y, np.array([1.0, np.nan]), dt=1.0, steps=1
        ),
    }
    row = Kind("refused", "an error of ours", must=REFUSED)
    for name, run in tries.items():
        yield row(name, lambda run=run: float(run() is not None))
    yield Kind("overflow", "an error, no warning of numpy's")(
        "5 stages, z = -1e10", _overflows, one
    )


def _decayed(u: np.ndarray, size: float, exact: np.ndarray) -> tuple[float, str]:
    """Relative to the solution; where that is below 1e-300, it has no digits left to compare."""
    greatest = float(np.abs(exact).max())
    if greatest * min(size, 1.0) < 1e-300:
        return float(np.abs(u / max(size, 1.0)).max() > 1e-299), "below every number"
    return float(np.abs(u / size - exact).max()) / greatest, f"{greatest:.0e} of the data"


def _relative(u: np.ndarray, exact: np.ndarray) -> tuple[float, str]:
    deviation = float(np.abs(u - exact).max() / np.abs(exact).max())
    return deviation, f"{deviation:.0e}"


def _overflows(step: ChebyshevStep) -> float:
    try:
        step.advance(lambda y: -1e10 * y, np.ones(3), dt=1.0, steps=1000)
    except NonFiniteSolution:
        return 0.0
    return 1.0
