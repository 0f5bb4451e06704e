"""What holds of every run: it is right against something else that is the same, or refused."""

# ruff: noqa: B008  an argument of a property is drawn from its default

import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from fracparticles.run.case import Case
from fracparticles.run.dataset import read_run, write
from fracparticles.run.reliability import LIMITS
from fracparticles.run.solution import relative_l1_error
from fracparticles.run.solve import solve
from fracparticles.run.solver import compute, prepare
from fracparticles.schemes import SCHEMES
from fracparticles.schemes.dpse import laplacian_weights, potential_weights
from fracparticles.schemes.spectrum import eigenvalue_bounds
from fracparticles.time import STEP_POLYNOMIALS
from fracstudy.probe import EPS, HELD
from scenes.extremes.dense import whole
from scenes.extremes.fuzzing.cases import cases, changed, refuse_dear, runs
from scenes.extremes.fuzzing.harness import NotRun, always

_LENGTHS = ("half_width", "spacing", "graded_scale")
_TIMES = ("t_initial", "t_final", "times", "dt")
# Of a run from the fundamental solution, (48): what the estimates together may leave without a word.
_NEAR = sum(LIMITS[name] for name in ("wave_error", "table_error", "outside_share", "kept"))
Run = tuple[Case, np.ndarray]


def _round_off(case: Case) -> float:
    """Return what two ways to do the same sums may differ by, of the greatest strength: 64 T |A| eps and more."""
    if case.is_graded:
        return 64.0 * EPS * case.particles
    size = max(map(abs, case.symbol_range))
    if case.scheme == "DPSE":  # the norm of the sum that it does first, times that of the second
        m = np.arange(2.0 * case.n + 1.0)
        of_both = (potential_weights(m, case.setting), laplacian_weights(m, case.setting))
        size = 4.0 * float(np.prod([np.abs(weights).sum() for weights in of_both]))
    # In the exterior of a box smooth modes cancel that are some hundred times as large.
    cancelled = 100.0 if case.dim > 1 and case.exterior == "open" else 1.0
    stiffness = case.span * case.setting.rate * size
    return 64.0 * EPS * (16.0 + stiffness + 2.0 * case.steps) * cancelled


def _growth(case: Case) -> float:
    """Return the greatest factor by which the steps amplify a wave, which they do to round-off, too."""
    if case.is_graded or (case.kind.self_timed and case.is_one_step):
        return 1.0
    setting = case.setting
    exponents = case.span * setting.rate * np.array(case.symbol_range)
    if not case.kind.moving and exponents.max() <= 0.0:  # the ends may amplify waves, too
        operator = SCHEMES[case.scheme].operator(setting)
        exponents = case.span * np.array(eigenvalue_bounds(case.scheme, setting, operator))
    if case.steps:
        polynomial = STEP_POLYNOMIALS[case.resolved_integrator]
        _, exponents = polynomial.log_power(exponents / case.steps, case.steps)
    return float(np.exp(max(0.0, min(exponents.max(), 700.0))))


def _apart(case: Case, u: np.ndarray, v: np.ndarray, *of: np.ndarray) -> float:
    """Return how far u is from v, in units of round-off of the greatest of them and of the data, as it may grow."""
    data = max((float(np.abs(one).max()) for one in of), default=0.0)
    size = max(float(np.abs(u).max()), float(np.abs(v).max()), data)
    if size == 0.0:
        return 0.0
    grown = max(1.0, _growth(case) * (data / size))
    return float(np.abs(u / size - v / size).max()) / (_round_off(case) * grown)


def _only_operators(case: Case) -> None:
    """Leave out what has no operator on its lattice, or continues its data anew in each run."""
    if case.kind.moving or case.is_graded or case.evaluation == "convolution":
        raise NotRun("no operator")


def _final(case: Case, u0: np.ndarray | None = None) -> np.ndarray:
    return compute(refuse_dear(case), u0).u


# --- right against something independent ----------------------------------------------------------------


@always(
    "a run, fundamental", f"a relative error of {_NEAR:g} at most, or a warning", "closed form", 4
)
def _exact(case=cases()):
    """From the fundamental solution to the fundamental solution."""
    refuse_dear(case)
    return relative_l1_error(case, _final(case)) / _NEAR


@always("a run, rough data", "exp(A T) u, or p(A dt)^n u", "scipy, dense matrix", 2, HELD)
def _matrix(run=runs()):
    """exp(A T) by scipy, or the n-th power of the step's polynomial, A from naive sums over unit vectors."""
    case, u0 = run
    _only_operators(case)
    if case.particles > 300 or case.span * case.setting.rate > 1e8:
        raise NotRun("too large for a matrix")
    u = _final(case, u0)
    matrix = whole(case, summation="naive")
    size = max(float(np.abs(u0).max()), 1e-300)
    expected = (matrix @ (u0.reshape(-1) / size)).reshape(u0.shape) * size
    return _apart(case, u, expected, u0)


@always("a run, naive sums", "that by transforms", "naive sums", must=HELD)
def _naive(run=runs()):
    """The sums by transforms against those one by one."""
    case, u0 = run
    naive = refuse_dear(changed(case, summation="naive"))
    return _apart(case, _final(case, u0), _final(naive, u0), u0)


# --- right against itself ---------------------------------------------------------------------------------


@always("a run, mirrored", "the mirrored run", share=2, must=HELD)
def _mirrored(run=runs()):
    """The mirrored data give the mirrored solution."""
    case, u0 = run
    axes = tuple(range(case.dim))
    return _apart(case, np.flip(_final(case, np.flip(u0, axes)), axes), _final(case, u0), u0)


@always("a run, linear", "the sum of two runs", share=2, must=HELD)
def _linear(run=runs()):
    """A sum of data gives the sum of solutions, each times its factor."""
    case, u0 = run
    if case.kind.moving:
        raise NotRun("not linear")
    v0 = np.roll(u0, 3) if u0.any() else np.ones(case.shape)
    u, v = _final(case, u0), _final(case, v0)
    return _apart(case, _final(case, 0.25 * u0 - 0.5 * v0), 0.25 * u - 0.5 * v, u0, v0, u, v)


@always("a run, other units", "the same run", share=2, must=HELD)
def _scaled(run=runs()):
    """Lengths times c, times times c^alpha / d and D times d leave the strengths as they are."""
    case, u0 = run
    c, d = 2.0**7, 2.0**-5
    factors = dict.fromkeys(_LENGTHS, c) | dict.fromkeys(_TIMES, c**case.alpha / d)
    fields = {
        name: tuple(factor * t for t in value) if isinstance(value, tuple) else factor * value
        for name, factor in factors.items()
        if (value := getattr(case, name, None)) is not None
    }
    other = changed(case, **fields, diffusivity=case.diffusivity * d)
    if other.steps != case.steps:
        raise NotRun("a step more for round-off")
    return _apart(case, _final(other, u0), _final(case, u0), u0)


@always("a run, in two parts", "the run at once", share=2, must=HELD)
def _in_two_parts(run=runs()):
    """To the middle, and from there to the end."""
    case, u0 = run
    _only_operators(case)
    if case.steps % 2 or case.kind.self_timed:
        raise NotRun("no step ends in the middle")
    middle = case.t_initial + 0.5 * case.span
    first, last = changed(case, t_final=middle), changed(case, t_initial=middle)
    if (first.n, last.n, 2 * first.steps, 2 * last.steps) != (case.n,) * 2 + (case.steps,) * 2:
        raise NotRun("other particles, or other steps")
    half = _final(first, u0)
    return _apart(case, _final(last, half), _final(case, u0), u0, half)


# --- right in whatever form ---------------------------------------------------------------------------------


@always("a run, prepared", "the same bits", must=HELD)
def _prepared(run=runs()):
    """`prepare` and `solve` on bare arrays give the bits that `compute` gives, twice.

    Where strengths are next to the ends of float64, which `compute` moves away from there, to round-off.
    """
    case, u0 = run
    u, ready = _final(case, u0), prepare(case)
    v, again = ready.solve(u0), ready.solve(u0)
    wrong = not np.array_equal(again, v)
    if not 1e-200 < np.abs(u0).max() < 1e200:
        return max(2.0 * wrong, _apart(case, u, v, u0))
    return 2.0 * (wrong or not np.array_equal(u, v))


@always("a run, in a file", "the same run, no other file", must=HELD)
def _in_a_file(run=runs()):
    """A run that is written is read as it was, alone in its folder, and goes on from its file."""
    case, u0 = run
    found = solve(refuse_dear(case), u0)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / case.path
        write(found, path)
        wrong = not read_run(path).identical(found)
        wrong |= [file for file in Path(folder).rglob("*") if file.is_file()] != [path]
        stored = Case.from_json(found.attrs["case"])
        wrong |= not solve(stored, u0).identical(found)
    return 2.0 * wrong


_BACKWARDS = slice(None, None, -1)
_DISGUISES: dict[str, Callable[[Case, np.ndarray], Any]] = {
    "nested lists": lambda case, u: u.tolist(),
    "in Fortran's order": lambda case, u: np.asfortranarray(u),
    "a view with strides": lambda case, u: np.repeat(u, 2, axis=0)[::2],
    "read-only": lambda case, u: np.frombuffer(u.tobytes()).reshape(u.shape),
    "big-endian": lambda case, u: u.astype(">f8"),
    "a function": lambda case, u: lambda *_: u,
    "masked without a mask": lambda case, u: np.ma.masked_array(u, False),
    "with labels, reversed": lambda case, u: _with_labels(case, u)[(_BACKWARDS,) * u.ndim],
    "with labels, transposed": lambda case, u: _with_labels(case, u).T,
}


def _with_labels(case: Case, u: np.ndarray) -> Any:
    import xarray as xr

    axes = ("x", "y", "z")[: case.dim]
    return xr.DataArray(u, {axis: case.x for axis in axes}, axes)


@always("a run, data in disguise", "the same bits", must=HELD)
def _disguised(run=runs()):
    """The data in other clothes give the same bits."""
    case, u0 = run
    u, before = _final(case, u0), u0.copy()
    same = [np.array_equal(_final(case, wear(case, u0)), u) for wear in _DISGUISES.values()]
    return 2.0 * (not all(same) or not np.array_equal(u0, before))
