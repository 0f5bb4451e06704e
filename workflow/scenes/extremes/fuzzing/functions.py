"""What holds of the functions of the library, for arguments of all kinds."""

# ruff: noqa: B008  an argument of a property is drawn from its default

import inspect
import math
import pickle
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from hypothesis import strategies as st
from scipy.integrate import quad
from scipy.special import gamma

import fracparticles as fp
from fracparticles.graded.particles import FORMS
from fracparticles.kernels.families import FAMILIES, KERNELS, kernel_transform
from fracparticles.schemes import ALL_SCHEMES, SCHEMES, Setting
from fracparticles.schemes.spectrum import scheme_matrix
from fracstudy.probe import EPS, HELD, off
from scenes.extremes.fuzzing.cases import cases, refuse_dear
from scenes.extremes.fuzzing.harness import NotRun, always
from scenes.extremes.fuzzing.strategies import among, anything, between, chance, numbers, texts
from scenes.extremes.long_and_short_times.profile import solution

_ALPHAS = st.one_of(
    between(1.02, 1.98), between(1.02, 1.98), among(1.0 + 1e-9, 1.001, 1.999, 2.0 - 1e-9)
)
_KINDS = {name: getattr(fp, name) for name in fp.__all__ if isinstance(getattr(fp, name), type)}
_ERRORS = [name for name, kind in _KINDS.items() if issubclass(kind, BaseException)]
_CALLED = [name for name in fp.__all__ if callable(getattr(fp, name)) and name not in _ERRORS]

# --- anything for every argument -------------------------------------------------------------------------

# What an argument of that name is likely to be; of another name, what its annotation says, or anything.
_LIKELY: dict[str, st.SearchStrategy[Any]] = {
    "alpha": _ALPHAS,
    "beta": between(0.02, 0.98),
    "dim": st.integers(1, 3),
    "order": among(2, 4, 6, 8, 10, 12),
    "overlap": between(0.8, 4.0),
    "terms": st.integers(0, 6),
    "points": st.integers(3, 40),
    "count": st.integers(1, 30),
    "form": st.sampled_from(FORMS),
    "family": among(None, *FAMILIES),
    "name": st.sampled_from(tuple(KERNELS)),
    "scheme": st.sampled_from(tuple(ALL_SCHEMES)),
    "case": cases(),
    "tail": st.one_of(st.none(), st.lists(numbers(0.0, 9.0), max_size=3)),
    "stretch": st.one_of(st.none(), between(1.0, 4.0)),
    "operator": st.none(),
    "amplification": st.none(),
}
_ARRAYS = st.tuples(st.integers(0, 12), st.integers(0, 10**6), among(1.0, 1.0, 1e-200, 1e200)).map(
    lambda drawn: drawn[2] * np.random.default_rng(drawn[1]).standard_normal(drawn[0])
)


def _argument(parameter: inspect.Parameter) -> st.SearchStrategy[Any]:
    likely = _LIKELY.get(parameter.name)
    if likely is None:
        said = str(parameter.annotation)
        positive = numbers(0.0, 1e100, inside=(True, False))
        likely = {"float": positive, "int": st.integers(-2, 40), "str": texts()}.get(said, _ARRAYS)
    return st.one_of(likely, likely, likely, anything())


@st.composite
def _calls(draw: st.DrawFn) -> tuple[str, dict[str, Any]]:
    """Draw a name of the package and arguments for it: mostly likely ones."""
    name = draw(st.sampled_from(_CALLED))
    taken = inspect.signature(getattr(fp, name)).parameters.values()
    given = {
        one.name: draw(_argument(one))
        for one in taken
        if one.kind not in (one.VAR_KEYWORD, one.VAR_POSITIONAL)
        and (one.default is one.empty or draw(chance(50)))
    }
    return name, given


@always("arguments of every name", "a result, or a line", share=25)
def _called(call=_calls()):
    """A call returns, or is refused; what it was given is as it was, and there is no file but a whole one."""
    name, given = call
    points, stretch = given.get("points", 0), given.get("stretch", 0)
    large = isinstance(points, int | np.integer) and points > 100
    if name in ("WholeSpace", "evolve") and (
        large or (isinstance(stretch, int | float) and stretch > 100.0)
    ):
        raise NotRun("many points")
    if isinstance(given.get("case"), fp.Case):
        refuse_dear(given["case"])
        if name in ("solve", "prepare") and given["case"].dim == 3:
            raise NotRun("other properties take it")
    arrays = {key: value.copy() for key, value in given.items() if type(value) is np.ndarray}
    with tempfile.TemporaryDirectory() as folder:
        if name in ("read_run", "write"):
            given = {**given, "path": _inside(folder, given.get("path"))}
        result = getattr(fp, name)(**given)
        if name == "write":
            left = [file for file in Path(folder).rglob("*") if file.is_file()]
            if len(left) != 1 or not fp.read_run(left[0]).identical(given["dataset"]):
                return 2.0
    for key, before in arrays.items():
        if not np.array_equal(given[key], before, equal_nan=before.dtype.kind in "fc"):
            return 2.0
    return 0.0 if not isinstance(result, np.ndarray) or not np.isnan(result).any() else 2.0


def _inside(folder: str, path: Any) -> Any:
    """A path in a folder of its own, of the kind and the name that was given."""
    if isinstance(path, str):
        return str(Path(folder) / "x") + path.replace("/", "_")
    return Path(folder) / "run.nc" if path is None or isinstance(path, Path) else path


_LINES = texts().map(lambda text: " ".join(text.split()))


@always("errors", "one line, the same when unpickled", "pickle", 5)
def _error(field=_LINES, value=anything(), allowed=_LINES, remedy=st.just("Mend it.")):
    """An error of ours is one line, whatever it is of, and goes from process to process."""
    wrong = False
    try:
        same = repr(pickle.loads(pickle.dumps(value))) == repr(value)  # without an address in it
    except Exception:  # the value's own
        same = False
    sent = (lambda error: pickle.loads(pickle.dumps(error))) if same else (lambda error: error)
    for name in _ERRORS:
        kind = getattr(fp, name)
        ours = kind is fp.InvalidInput
        error = kind(field, value, allowed, remedy) if ours else kind(f"{field} {allowed}")
        again = sent(error)
        wrong |= "\n" in str(error) or str(again) != str(error) or type(again) is not kind
    return 2.0 * wrong


# --- right against something independent -------------------------------------------------------------------


_XS = st.one_of(st.just(0.0), between(0.0, 3.0), between(0.0, 30.0))
_TIMES, _DIMS = numbers(1e-3, 1e3), st.integers(1, 3)


@always("green", "the Fourier integral", "scipy, quadrature", 5, HELD)
def _green(r=_XS, t=_TIMES, alpha=_ALPHAS, dim=_DIMS):
    """G by quadrature of its Fourier integral, to 1e-10 of its maximum."""
    scale = t ** (-1.0 / alpha)
    x = r / scale
    found = np.asarray(fp.green([x, -x], t, alpha, dim))
    most = scale**dim * gamma(dim / alpha) / alpha  # of the size of G(0)
    return off(found, solution(np.array([x, x]), t, alpha, dim), 1e-10 * most)


@always("green_rate, _slope, _flux", "differences of G", share=5, must=HELD)
def _rates(r=_XS, t=_TIMES, alpha=_ALPHAS, dim=_DIMS):
    """The rate is dG/dt, the slope dG/dr, and the flux r G / (alpha t): by differences of G, to 1e-6."""
    x, step = abs(r) * t ** (1.0 / alpha), 1e-4
    green = lambda x, t: float(np.asarray(fp.green(x, t, alpha, dim)))
    most = green(0.0, t)

    def slope(of: Callable[[float], float]) -> float:  # of fourth order, per relative step
        return (8.0 * (of(step) - of(-step)) - of(2.0 * step) + of(-2.0 * step)) / (12.0 * step)

    by_time = slope(lambda s: green(x, t * (1.0 + s)) / most)
    width = t ** (1.0 / alpha)
    by_place = slope(lambda s: green(x + width * s, t) / most)
    found = (
        float(fp.green_rate(x, t, alpha, dim)) * t / most - by_time,
        float(fp.green_slope(x, t, alpha, dim)) * width / most - by_place,
        float(fp.green_flux(x, t, alpha, dim)) / most * alpha * t / width
        - x / width * green(x, t) / most,
    )
    return max(map(abs, found)) / 1e-6


@always("mean_radius", "(2 / pi) Gamma(1 - 1 / alpha)", "closed form", 3, HELD)
def _radius(alpha=_ALPHAS):
    return abs(fp.mean_radius(alpha) * math.pi / (2.0 * gamma(1.0 - 1.0 / alpha)) - 1.0) / (
        16.0 * EPS / (alpha - 1.0)
    )


@always("evolve, fundamental", "the fundamental solution, or a warning", "closed form", 3)
def _evolved(
    alpha=_ALPHAS,
    half=st.integers(4, 200),
    start=between(0.1, 3.0),
    span=between(0.01, 5.0),
    terms=st.integers(1, 6),
):
    """From the fundamental solution to the fundamental solution, to a thousandth, or a warning."""
    h = 0.25
    x = h * np.arange(-half, half + 1)
    found = fp.evolve(np.asarray(fp.green(x, start, alpha)), h, alpha, span, terms=terms)
    exact = np.asarray(fp.green(x, start + span, alpha))
    return off(found, exact) / 2e-2


@always("evolve, periodic", "every wave decays", "dense matrix", 3, HELD)
def _periodic(
    points=st.integers(8, 60), alpha=_ALPHAS, time=numbers(1e-6, 1e6), seed=st.integers(0, 10**6)
):
    """Without terms it is a diagonal on the waves of the lattice: the transform as a dense matrix."""
    u = np.random.default_rng(seed).standard_normal(points)
    k = 2.0 * np.pi * np.arange(points) / points
    waves = np.exp(1j * np.outer(np.arange(points), k))
    decay = np.exp(-time * np.minimum(k, 2.0 * np.pi - k) ** alpha)
    expected = (waves * decay @ waves.conj().T).real @ u / points
    return float(np.abs(fp.evolve(u, 1.0, alpha, time, terms=0) - expected).max()) / (
        1e-13 * points
    )


@always("graded_particles, green_step", "the sums one by one", "naive sums", 2, HELD)
def _graded(
    half=st.integers(1, 8),
    reach=between(0.5, 50.0),
    alpha=_ALPHAS,
    time=numbers(1e-2, 1e2),
    form=st.sampled_from(FORMS),
):
    """The step against the sums one by one; the interpolated one mirrors and does not grow."""
    count = 2 * half + 1
    x, volumes = fp.graded_particles(count, reach, 1.0)
    matrix = fp.green_step(x, volumes, alpha, time, form)
    naive = np.zeros((count, count))
    for i in range(count):
        for j in range(count):
            if i != j or form == "quadrature":
                naive[i, j] = volumes[j] * fp.green(x[i] - x[j], time, alpha)
        if form == "exchange":
            naive[i, i] = 1.0 - naive[i].sum()
    of_field = fp.green_step_of_field(count, reach, 1.0, alpha, time)
    mirrored = np.abs(of_field - of_field[::-1, ::-1]).max()
    size = max(1.0, float(np.abs(naive).max()))
    return max(float(np.abs(matrix - naive).max()) / size, float(mirrored)) / (64.0 * EPS * count)


@always("kernel", "the integral of its transform", "scipy, quadrature", 3, HELD)
def _kernel(
    name=st.sampled_from(tuple(KERNELS)), r=between(0.05, 8.0), alpha=_ALPHAS, order=among(2, 4, 8)
):
    """A kernel by quadrature of its transform, to 1e-8."""
    odd = KERNELS[name].parity == "odd"
    if name == "kappa":
        raise NotRun("no plain integral")
    end = 42.0 ** (1.0 / alpha) if name == "E" else 30.0 + 2.0 * order
    hat = lambda k: float(np.asarray(kernel_transform(name, k, alpha, 1, order)))
    how: dict[str, Any] = {"weight": "sin" if odd else "cos", "wvar": r, "epsabs": 1e-12}
    value = quad(hat, 0.0, end, limit=400, **how)[0] / math.pi
    return off(fp.kernel(name, r, alpha, 1, order), -value if odd else value, 1e-8)


@always("stability_limit", "the spectral radius", "dense matrix", must=HELD)
def _limit(
    name=among("DD", "KPSE", "FPSE", "FD"), beta=between(0.05, 0.95), overlap=between(0.8, 3.0)
):
    """2 / a is the spectral radius of the matrix of many particles, from below."""
    overlap = overlap if SCHEMES[name].has_kernel else 2.0
    setting = Setting(alpha=1.0 + beta, overlap=overlap, n=24)
    radius = float(np.abs(np.linalg.eigvals(scheme_matrix(name, setting))).max())
    a = fp.stability_limit(name, beta, overlap=overlap)
    low = 2.0 / a if a > 0.0 else math.inf
    return 0.0 if 0.8 * low <= radius <= 1.02 * low or not a else 2.0
