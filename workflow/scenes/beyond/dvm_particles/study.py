r"""The diffusion velocity method (Sec. 3.3): where its particles go, and what becomes of their lattice.

For the fundamental solution the velocity (44) is x / (alpha t): the paths are x_i(t) = x_i (t / t0)^(1/alpha), and
spacings grow in proportion.
"""

import numpy as np
import pandas as pd

from fracparticles.run.case import Case
from fracparticles.run.solver import advect, initial_strengths
from fracparticles.special.stable import mean_radius
from fracstudy.inputs import Inputs, Result
from fracstudy.panels import Panels

NEEDS = {"scheme": ["DVM"], "remeshing": ["none", "M4'"]}

_FRAMES = 120  # instants of a path that the figure shows
_MOST_GAPS = 400  # points of a curve of spacings
_LAST_GAPS = 60  # the ones that count: all of them are shown


def spread(time: np.ndarray | float, start: float, alpha: float) -> np.ndarray:
    """Return (t / t0)^(1/alpha), by which the exact paths stretch the lattice."""
    return np.asarray((np.asarray(time) / start) ** (1.0 / alpha))


def study(inputs: Inputs, *, times: list[float], every: int) -> Result:
    """Paths and spacings without remeshing, beside the exact ones, and the spacings before every remeshing.

    Its two runs differ in `remeshing` alone: "none" and another one. The bulk is what starts in |x| <= 5 R_alpha.
    The table and the spacings are at the `times`; the path of one particle in `every` is drawn.
    """
    case = Case.from_json(inputs.open(remeshing="none").attrs["case"])
    other = next(name for name in inputs.scalars["remeshing"] if name != "none")
    remeshed = inputs.open(remeshing=other)
    h, overlap = case.particle_spacing, case.resolved_overlap
    states: list[tuple[float, np.ndarray]] = []
    advect(case, initial_strengths(case)[0], lambda t, x, _: states.append((t, x)))
    time, places = np.array([t for t, _ in states]), [x for _, x in states]
    stretch = spread(time, case.t_initial, case.alpha)
    inner = np.abs(0.5 * (case.x[1:] + case.x[:-1])) <= 5.0 * mean_radius(case.alpha)
    gaps = [np.diff(x) for x in places]
    bulk, widest = np.array([(gap[inner].max(), gap.max()) for gap in gaps]).T
    when, where = remeshed["remeshing_time"].values, np.abs(remeshed["spacing_where"].values)
    before = remeshed["spacing_before"].values / h
    above = 1.5 if case.remesh_above is None else case.remesh_above
    rows, panels = [], Panels()
    for asked in times:
        k = int(np.argmin(np.abs(time - asked)))
        x, exact, so_far = places[k], float(stretch[k]), when <= time[k] + 0.5 * case.time_step
        row = {
            "t": time[k],
            "exact spacing / h": exact,
            "bulk spacing / h": bulk[k] / h,
            "largest spacing / h": widest[k] / h,
            "overlap in the bulk": overlap / (bulk[k] / h),
            "last particle": x.max(),
            "last particle, exact": case.reach * exact,
            "remeshings the bulk would need": int(np.log(bulk[k] / h) / np.log(above)),
            f"remeshings, {other}": int(so_far.sum()),
            "steps": k,
            "largest spacing before a remeshing / h": before[so_far].max(initial=0.0),
            "nearest to the centre / D": where[so_far].min(initial=np.inf) / case.reach,
        }
        rows.append(row)
        at = 0.5 * (x[1:] + x[:-1])
        kept = np.flatnonzero(at >= 0.0)
        thinned = kept[:: max(1, kept.size // _MOST_GAPS)]
        kept = np.union1d(thinned, kept[-_LAST_GAPS:])
        panels.add("spacing", "none", at[kept], gaps[k][kept] / h, label=time[k])
        panels.add("spacing", "exact", at.max(), exact, label=time[k])
    some = slice(None, None, max(1, when.size // _MOST_GAPS))
    panels.add("spacing", other, where[some], before[some], label=when[some])
    _paths(panels, case, time, places, every)
    thin = slice(None, None, max(1, time.size // _FRAMES))
    panels.add("overlap", "none, bulk", time[thin], (overlap * h / bulk)[thin], label=0.0)
    panels.add("overlap", "none, ends", time[thin], (overlap * h / widest)[thin], label=0.0)
    panels.add("overlap", f"{other}, ends", when[some], overlap / before[some], label=0.0)
    panels.add("overlap", "exact", time[thin], overlap / stretch[thin], label=0.0)
    return Result(pd.DataFrame(rows), (), panels.frame)


def _paths(
    panels: Panels, case: Case, time: np.ndarray, places: list[np.ndarray], every: int
) -> None:
    """The paths of every k-th particle from the centre, of the two last ones, and the exact ones."""
    frames = np.unique(np.linspace(0, time.size - 1, _FRAMES).astype(int))
    x, shown, last = np.array([places[k] for k in frames]), time[frames], 2 * case.n
    stretch = spread(shown, case.t_initial, case.alpha)
    for i in sorted({0, last, *range(case.n % every, last + 1, every)}):
        panels.add("path", "none", x[:, i], shown, label=i)
        panels.add("path", "exact", case.x[i] * stretch, shown, label=i)
