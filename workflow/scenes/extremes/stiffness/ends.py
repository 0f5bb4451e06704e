"""What is left at the end of a stiff run, and what is said or refused."""

from collections.abc import Iterator
from dataclasses import replace
from itertools import product

import mpmath as mp
import numpy as np

from fracparticles.errors import NonFiniteSolution
from fracparticles.run.case import Case
from fracparticles.run.solver import compute, prepare
from fracparticles.time.rkc import ChebyshevStep, stages_for
from fracstudy.probe import HELD, REFUSED, WARNED, Kind, Probe, off
from scenes.extremes.stiffness.ways import Stiff, deviation_of, exact_modes, power_of_step, stiff

_MEAN = Kind("the end", "the mean of the data everywhere", source="closed form", must=HELD)


def _exponential(one: Stiff, stiffness: float) -> Case:
    return one.case(integrator="exponential", t_final=stiffness / -one.lowest)


def conservation(half: int, stiffness: list[float]) -> Iterator[Probe]:
    """The mass of the exchange schemes, and of KPSE, whose matrix is symmetric, the end: the mean everywhere."""
    mass = Kind("mass", "that of the data", source="closed form", must=HELD)
    for scheme, value in product(("KPSE", "FPSE", "DPSE"), stiffness):
        if scheme != "KPSE" and value > 1e7:
            continue
        one = stiff(scheme, half)
        solve, u0, bound = prepare(_exponential(one, value)).solve, one.u0, one.bound(value)
        name = f"{scheme}, exponential, T |lambda| = {value:.0e}"
        yield mass(name, lambda: abs(solve(u0).sum() / u0.sum() - 1.0), bound=bound)
        if scheme == "KPSE" and value >= 1e6:
            yield _MEAN(name, lambda: off(solve(u0) / u0.mean(), 1.0), bound=bound)


def decay(schemes: list[str], half: int, stiffness: list[float]) -> Iterator[Probe]:
    """Where the ends absorb, u falls below every number: it is zero then, from data of every size, and nobody waits.

    Data of 1e-290 decay as those of one do, with the same digits, down to the smallest number.
    """
    right = Kind("decay", "that of its modes, or zero", source="mpmath", must=HELD)
    for scheme in (name for name in ("DD", "FD") if name in schemes):
        one = stiff(scheme, half)
        of = exact_modes(one)
        for value in (value for value in stiffness if value <= 1e9):
            time, solve = value / -one.lowest, prepare(_exponential(one, value)).solve
            for size in (1.0, 1e-250, 1e250):
                yield right(
                    f"{scheme}, u of {size:.0e}, T |lambda| = {value:.0e}",
                    lambda: _decayed(solve(size * one.u0), size, of(lambda z: mp.exp(z * time))),
                    bound=one.bound(value) + 1e-9,  # so many pieces, each to 1e-10
                )


def _decayed(u: np.ndarray, size: float, exact: np.ndarray) -> tuple[float, str]:
    """Relative to the solution; where that is below 1e-300, it has no digits left to compare."""
    greatest = float(np.abs(exact).max())
    if greatest * min(size, 1.0) < 1e-300:
        return float(np.abs(u / max(size, 1.0)).max() > 1e-299), "below every number"
    return off(u / size, exact), f"{greatest:.0e} of the data"


def at_the_limit(half: int, stiffness: list[float]) -> Iterator[Probe]:
    """Series of so many steps, of the limit itself and of a millionth: p(A dt)^n in forty digits.

    A step at the limit hardly damps the shortest wave; the series may amplify what is beyond by two, over the run.
    """
    one = stiff("KPSE", half)
    of = exact_modes(one)
    # n steps may come out as n (1 - 1e-9)
    for integrator, share in product(("euler", "rk2", "rk4"), (1e-6, 1.0 - 1e-8)):
        dt = share * one.case(integrator=integrator, dt=1.0).largest_stable_step
        for value in stiffness if share > 0.5 else stiffness[:-1]:
            steps = max(2, int(value / -one.lowest / dt))
            step = {"integrator": integrator, "dt": dt, "t_final": steps * dt}
            case = one.case(**step, evaluation="series")
            power = power_of_step(case)
            # Of rk4 the polynomial is steeper at the limit than the exponential anywhere.
            bound, expected = 10.0 * one.bound(value), f"p(A dt)^n, n = {case.steps:.0e}"
            yield Kind("many steps", expected, bound, "mpmath", HELD)(
                f"KPSE, {integrator}, dt = {share:g} a, T |lambda| = {value:.0e}",
                lambda: deviation_of(prepare(case).solve(one.u0), of(power)),
            )


def spoken_of(half: int, stiffness: list[float]) -> Iterator[Probe]:
    """T |lambda| so large that round-off matters: a warning, and the error within what it says, 64 T |lambda| eps."""
    one = stiff("KPSE", half)
    told = replace(_MEAN, kind="a word", expected="the mean, and a warning of the round-off")
    for value in sorted({1e8, max(1e8, *stiffness)}):
        yield told(
            f"KPSE, exponential, T |lambda| = {value:.0e}",
            lambda: off(compute(_exponential(one, value), one.u0).u / one.u0.mean(), 1.0),
            bound=one.bound(value),
            must=WARNED,
        )


def refused(half: int) -> Iterator[Probe]:
    """Runs that would take too long, steps that are too many, stages beyond the last."""
    kpse, fpse = stiff("KPSE", half), stiff("FPSE", half)
    one, ones, hole = ChebyshevStep(5), np.ones(3), np.array([1.0, np.nan])
    yield from Kind("refused", "an error of ours", must=REFUSED).of(
        {
            "T |lambda| = 1e13": lambda: prepare(kpse.case(integrator="exponential", t_final=1e13)),
            "FPSE, T |lambda| = 1e11": lambda: prepare(_exponential(fpse, 1e11)),
            "1e17 steps": lambda: kpse.case(integrator="rk2", dt=1e-17, t_final=1.0),
            "a stabilised step of z = 5e4": lambda: stages_for(5e4),
            "251 stages": lambda: ChebyshevStep(251),
            "rates of another shape": lambda: one.advance(lambda y: y[:-1], ones, dt=1.0, steps=1),
            "data that are nan": lambda: one.advance(lambda y: -y, hole, dt=1.0, steps=1),
        }
    )
    yield Kind("overflow", "an error, no warning of numpy's")(
        "5 stages, z = -1e10", _overflows, one
    )


def _overflows(step: ChebyshevStep) -> float:
    try:
        step.advance(lambda y: -1e10 * y, np.ones(3), dt=1.0, steps=1000)
    except NonFiniteSolution:
        return 0.0
    return 1.0
