r"""The diffusion velocity method (Sec. 3.3): where its particles go, and what becomes of their lattice.

For the fundamental solution the velocity (44) is x / (alpha t): the paths are x_i(t) = x_i (t / t0)^(1/alpha), and
spacings grow in proportion.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from fracparticles.moving import dvm
from fracparticles.moving.lagrangian import Observer
from fracparticles.moving.remeshing import remesh
from fracparticles.run.case import Case
from fracparticles.run.solver import initial_strengths
from fracparticles.special.stable import mean_radius
from fracstudy.inputs import Inputs, Result

__all__ = ["lattice_strengths", "observed_run", "spread", "study"]

_FRAMES = 120  # instants of a path that the figure shows
_MOST_GAPS = 400  # points of a curve of spacings


def spread(time: np.ndarray | float, start: float, alpha: float) -> np.ndarray:
    """Return (t / t0)^(1/alpha), by which the exact paths stretch the lattice."""
    return np.asarray((np.asarray(time) / start) ** (1.0 / alpha))


def lattice_strengths(run: xr.Dataset, name: str | None = None) -> np.ndarray:
    """Return U_p / h on the lattice x of a run, after one last remeshing of its particles.

    That is how DVM has strengths u_p on common points, as Eqs. (48), (49) need them; the other way is the field
    (7), which the run holds as u.

    Parameters
    ----------
    run : Dataset
        A run of DVM that stores its field.
    name : str, optional
        Interpolation function; the run's own if left out.
    """
    h, x = float(run["particle_spacing"]), run["x"].values
    wanted = str(run["remeshing"].values) if name is None else name
    z, strength = remesh(
        run["particle_position"].values, run["particle_strength"].values, h, wanted
    )
    total = np.zeros(x.size)
    place = np.rint((z - x[0]) / h).astype(int)
    inside = (place >= 0) & (place < x.size)
    total[place[inside]] = strength[inside]
    return total / h


@dataclass
class _Watch:
    """Observes a run: its particles at some instants, the largest spacings at all."""

    center: np.ndarray  # the gaps of the bulk, |x| <= 5 R_alpha at the start
    keep: list[np.ndarray] = field(default_factory=list)
    times: list[float] = field(default_factory=list)
    bulk: list[float] = field(default_factory=list)
    widest: list[float] = field(default_factory=list)

    def __call__(self, time: float, x: np.ndarray, strength: np.ndarray) -> None:
        gap = np.diff(x)
        self.times.append(time)
        self.keep.append(x)
        self.bulk.append(float(gap[self.center].max()))
        self.widest.append(float(gap.max()))


def observed_run(case: Case, observe: Observer, u0: np.ndarray | None = None) -> dvm.ParticleRun:
    """Run a case of DVM under observation, from the fundamental solution or from u0 on its lattice."""
    return dvm.run(
        case.x,
        initial_strengths(case)[0] if u0 is None else u0,
        spacing=case.particle_spacing,
        alpha=case.alpha,
        order=case.order,
        overlap=case.epsilon_over_h,
        diffusivity=case.diffusivity,
        start=case.t_initial,
        dt=case.time_step,
        steps=case.steps,
        remeshing=case.remeshing or "M4'",
        observe=observe,
    )


def study(inputs: Inputs) -> Result:
    """Paths and spacings without remeshing, beside the exact ones, and the spacings before every remeshing.

    Its two runs differ in `remeshing` alone: "none" and another one. The bulk is what starts in |x| <= 5 R_alpha.
    Parameters: `times` of the table and of the spacings, `every` which particle's path is drawn.
    """
    free = inputs.open(remeshing="none")
    other = next(name for name in inputs.scalars["remeshing"] if name != "none")
    remeshed = inputs.open(remeshing=other)
    case = Case.from_json(free.attrs["case"])
    start, h, alpha = case.t_initial, case.particle_spacing, case.alpha
    middle = 0.5 * (case.x[1:] + case.x[:-1])
    watch = _Watch(np.abs(middle) <= 5.0 * mean_radius(alpha))
    observed_run(case, watch)
    time = np.array(watch.times)
    when = remeshed["remeshing_time"].values
    before = remeshed["spacing_before"].values / h
    where = np.abs(remeshed["spacing_where"].values)
    rows, series = [], []
    for asked in inputs.parameters["times"]:
        k = int(np.argmin(np.abs(time - asked)))
        x, exact = watch.keep[k], spread(time[k], start, alpha)
        bulk = watch.bulk[k] / h
        so_far = when <= time[k] + 0.5 * case.time_step
        rows.append(
            {
                "t": time[k],
                "exact spacing / h": float(exact),
                "bulk spacing / h": bulk,
                "largest spacing / h": watch.widest[k] / h,
                "overlap in the bulk": case.epsilon_over_h / bulk,
                "last particle": x.max(),
                "last particle, exact": float(case.domain * exact),
                "remeshings the bulk would need": int(np.log(bulk) / np.log(_threshold(case))),
                f"remeshings, {other}": int(so_far.sum()),
                "steps": k,
                "largest spacing before a remeshing / h": before[so_far].max(initial=0.0),
                "nearest to the centre / D": where[so_far].min(initial=np.inf) / case.domain,
            }
        )
        gap, at = np.diff(x), 0.5 * (x[1:] + x[:-1])
        kept = np.flatnonzero(at >= 0.0)
        # The last gaps are the ones that count: all of them, the others thinned.
        kept = np.union1d(kept[:: max(1, kept.size // _MOST_GAPS)], kept[-60:])
        series.append(_long("spacing", "none", at[kept], gap[kept] / h, time[k]))
        series.append(_long("spacing", "exact", [at.max()], [float(exact)], time[k]))
    some = slice(None, None, max(1, when.size // _MOST_GAPS))
    series.append(_long("spacing", other, where[some], before[some], when[some]))
    series += _paths(watch, case, int(inputs.parameters["every"]))
    thin = slice(None, None, max(1, time.size // _FRAMES))
    overlap = case.epsilon_over_h
    for name, gaps in (("bulk", watch.bulk), ("ends", watch.widest)):
        series.append(
            _long("overlap", f"none, {name}", time[thin], (overlap * h / np.array(gaps))[thin], 0.0)
        )
    series.append(_long("overlap", f"{other}, ends", when[some], overlap / before[some], 0.0))
    exact_overlap = overlap / spread(time[thin], start, alpha)
    series.append(_long("overlap", "exact", time[thin], exact_overlap, 0.0))
    return Result(pd.DataFrame(rows), [], pd.concat(series, ignore_index=True))


def _threshold(case: Case) -> float:
    return 1.5 if case.remesh_above is None else case.remesh_above


def _paths(watch: _Watch, case: Case, every: int) -> list[pd.DataFrame]:
    """The paths of every k-th particle from the centre, of the two last ones, and the exact ones."""
    frames = np.unique(np.linspace(0, len(watch.times) - 1, _FRAMES).astype(int))
    time = np.array(watch.times)[frames]
    x = np.array([watch.keep[k] for k in frames])
    n = case.n
    chosen = [*range(n % every, 2 * n + 1, every)]
    stretch = spread(time, case.t_initial, case.alpha)
    parts = []
    for i in sorted({0, *chosen, 2 * n}):
        parts.append(_long("path", "none", x[:, i], time, i))
        parts.append(_long("path", "exact", case.x[i] * stretch, time, i))
    return parts


def _long(panel: str, series: str, x: Any, y: Any, label: Any) -> pd.DataFrame:
    return pd.DataFrame({"panel": panel, "series": series, "x": x, "y": y, "label": label})
