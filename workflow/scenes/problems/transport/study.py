"""Transport of fractional diffusion: on the lattice and by moving particles, on the line and in the plane."""

from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from fracparticles.moving.remeshing import REMESHINGS
from fracparticles.problems import Problem, solve_problem
from fracparticles.problems.moving_particles import solve_with_moving_particles
from fracparticles.special import green
from fracstudy.errors import off, quiet
from fracstudy.inputs import Inputs, Result
from fracstudy.orders import orders_by
from fracstudy.panels import Panels

_solved = partial(solve_problem, estimate=False)  # the errors are measured
_THETA = 1.0  # of the linear field
_SPREAD = 0.2  # diffusivity in the plane
_WIDE = 6.0  # scale to the power alpha from which the linear field is drawn
_FROM = 1.5  # where the blob that is rotated starts, and its time there is 1
_FIELDS = {"uniform": "1", "linear": f"-{_THETA}*x", "periodic": "sin(x)"}


def study(
    inputs: Inputs,
    *,
    alpha: float,
    spacings: list[float],
    finest: float,
    half_width: float,
    orders: list[int],
    steps: list[int],
    ou_times: list[float],
    plane_spacings: list[float],
    plane_half_width: float,
) -> Result:
    """Errors against the spacing, over the greatest of the solution, for three fields on the line and two in the plane.

    The exact solution is the fundamental one, shifted, with the scale of the linear field, or rotated; of the periodic
    field and of the shear it is the solution on a lattice of the `finest` spacing, of half the least in the plane.
    """
    panels = Panels()
    rows: list[dict[str, Any]] = []
    line = {"alpha": alpha, "half_width": half_width, "far_terms": 3}
    line |= {"t_initial": 1.0, "t_final": 2.0}
    with quiet():  # of the coarse and of the narrow ones
        for field, velocity in _FIELDS.items():
            carried = {**line, "velocity": velocity}
            rows += _on_the_line(field, carried, spacings, finest, orders, steps)
        rows += _in_the_plane(alpha, plane_spacings, plane_half_width, panels)
        _linear_field(line, spacings[-1], orders[-1], ou_times, panels)
    table = pd.DataFrame(rows)
    table["observed order"] = orders_by(table, ["field", "way"], "error")
    for (field, way), part in table.groupby(["field", "way"], sort=False):
        panels.add(f"error, {field}", way, part["h"].to_numpy(), part["error"].to_numpy())
    return Result(table, (), panels.frame)


def _stable(x: np.ndarray, time: float, alpha: float, start: float = 1.0) -> np.ndarray:
    """The linear field: the stable law a time after it had the scale start^(1/alpha)."""
    falls = np.exp(-alpha * _THETA * time)
    return np.asarray(green(x, start * falls + (1.0 - falls) / (alpha * _THETA), alpha))


def _exact(field: str, fields: dict[str, Any], finest: float) -> Callable[[np.ndarray], np.ndarray]:
    alpha = fields["alpha"]
    if field == "uniform":
        return lambda x: np.asarray(green(x - 1.0, 2.0, alpha))
    if field == "linear":
        return lambda x: _stable(x, 1.0, alpha)
    fine = _solved(
        Problem(**fields, order=12, spacing=finest, rtol=1e-10), lambda x: green(x, 1.0, alpha)
    )
    return lambda x: fine["u"].sel(x=x, method="nearest").values


def _on_the_line(
    field: str,
    fields: dict[str, Any],
    spacings: list[float],
    finest: float,
    orders: list[int],
    steps: list[int],
) -> Iterator[dict[str, Any]]:
    """A row for each spacing and each way."""
    exact = _exact(field, fields, finest)
    for h in spacings:
        for order in orders:
            run = _solved(Problem(**fields, order=order, spacing=h, rtol=1e-9))
            ours, known = run["u"].values, exact(run["x"].values)
            yield _row(field, f"lattice, order {order}", h, ours, known, run)
        problem = Problem(**fields, spacing=h)
        x = problem.case.x
        start, truth = green(x, 1.0, fields["alpha"]), exact(x)
        for remeshing in REMESHINGS:
            every = [solve_with_moving_particles(problem, start, n, remeshing) for n in steps]
            errors = [np.abs(u - truth).max() for u in every]
            best = every[int(np.argmin(errors))]
            yield _row(field, f"particles, {remeshing}", h, best, truth)


def _row(
    field: str, way: str, h: float, u: np.ndarray, exact: np.ndarray, run: xr.Dataset | None = None
) -> dict[str, Any]:
    """One row of the table; the error is the greatest, over the greatest of the solution."""
    peak = np.unravel_index(int(exact.argmax()), exact.shape)
    return {
        "field": field,
        "way": way,
        "h": h,
        "exact, at the peak": float(exact[peak]),
        "ours, at the peak": float(u[peak]),
        "error": off(u, exact),
        "integrator": "splitting" if run is None else str(run["integrator"].values),
        "evaluations": np.nan if run is None else int(run["evaluations"]),
    }


def _linear_field(
    fields: dict[str, Any], h: float, order: int, times: list[float], panels: Panels
) -> None:
    """The solution of the linear field at some times, ours and exact, where it is seen."""
    alpha, start = fields["alpha"], fields["t_initial"]
    longer = {name: value for name, value in fields.items() if name != "t_final"}
    at = tuple(start + time for time in times)
    run = _solved(
        Problem(**longer, velocity=_FIELDS["linear"], order=order, spacing=h, times=at),
        lambda x: green(x, _WIDE, alpha),
    )
    seen = run["x"].values[(np.abs(run["x"].values) <= 6.0)]
    panels.add("linear field", "start", seen, green(seen, _WIDE, alpha))
    for time, when in zip(times, at, strict=True):
        panels.add("linear field", f"exact, t = {time:g}", seen, _stable(seen, time, alpha, _WIDE))
        ours = run["u"].sel(t=when, method="nearest").sel(x=seen)
        panels.add("linear field", f"ours, t = {time:g}", seen, ours.values)


def _in_the_plane(
    alpha: float, spacings: list[float], half_width: float, panels: Panels
) -> Iterator[dict[str, Any]]:
    """A quarter of a turn of a blob, and a shear; the first is also drawn, at each twelfth of a turn."""
    plane = {
        "alpha": alpha, "dim": 2, "form": "DD", "order": 12, "half_width": half_width, "diffusivity": _SPREAD,
    }  # fmt: skip
    quarter = 0.5 * np.pi

    def blob(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        return np.asarray(green(np.hypot(x - _FROM, y), 1.0, alpha, 2))

    finest = 0.5 * spacings[-1]
    sheared = Problem(**plane, velocity=("sin(y)", 0.0), t_final=1.0, spacing=finest)
    reference = _solved(sheared, blob)["u"]
    for h in spacings:
        turned = Problem(
            **plane, velocity=("-y", "x"), times=(quarter / 3.0, quarter / 1.5, quarter), spacing=h
        )
        run = _solved(turned, blob)
        x, y = run["x"].values[:, None], run["y"].values
        end = run["u"].isel(t=-1)
        exact = np.asarray(green(np.hypot(x, y - _FROM), 1.0 + _SPREAD * quarter, alpha, 2))
        yield _row("rotation", "lattice, order 12", h, end.values, exact, run)
        if h == spacings[-1]:
            _contours(run["u"], panels)
        run = _solved(sheared.model_copy(update={"spacing": h}), blob)
        fine = reference.sel(x=run["x"], y=run["y"], method="nearest")
        yield _row("shear", "lattice, order 12", h, run["u"].values, fine.values, run)


def _contours(u: xr.DataArray, panels: Panels) -> None:
    near = u.sel(x=slice(-4.0, 4.0), y=slice(-4.0, 4.0))
    x, y = np.meshgrid(near["x"], near["y"], indexing="ij")
    for k, field in enumerate(near):
        panels.add("rotation", k, x.reshape(-1), y.reshape(-1), value=field.values.reshape(-1))
