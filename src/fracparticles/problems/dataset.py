"""A solved problem as a data set. Its form is that of the data set of a run, see `run.dataset`."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from fracparticles.problems.integrate import Integration
from fracparticles.problems.problem import FORMS, Problem
from fracparticles.run.complaints import label_of
from fracparticles.run.dataset import along, described, scalar, source

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["Layout", "domain_layout", "lattice_layout", "to_dataset"]

# Fields that are stored as scalar coordinates: of every problem, and of one on a lattice.
_STORED = ("half_width", "form", "exterior", "dim", "t_initial", "t_final", "rtol")
_OF_A_LATTICE = ("order", "spacing", "overlap")


@dataclass(frozen=True)
class Layout:
    """Where the particles of a data set are.

    Attributes
    ----------
    axes : tuple of str
        Dimensions of u.
    coordinates : dict
        The coordinates by name, as xarray takes them.
    integral : callable
        Returns the sum of V u.
    scheme : str
        The name of the scheme or of the kind of particles.
    """

    axes: tuple[str, ...]
    coordinates: dict[str, tuple]
    integral: Callable[[np.ndarray], float]
    scheme: str


def lattice_layout(problem: Problem) -> Layout:
    """Return the layout of a lattice."""
    case, fields = problem.case, type(problem).model_fields
    axes = ("x", "y")[: problem.dim]
    coordinates = {
        name: scalar(_plain(getattr(problem, name)), label_of(fields[name]))
        for name in _OF_A_LATTICE
    }
    coordinates["particle_spacing"] = scalar(case.particle_spacing, "particle spacing, realised")
    coordinates |= {axis: along(axis, case.x, "particle position") for axis in axes}
    return Layout(axes, coordinates, case.integral, FORMS[problem.form])


def domain_layout(problem: Problem) -> Layout:
    """Return the layout of the particles of a bounded domain. Those of a disc lie on rings, at equal angles."""
    domain = problem.bounded_domain
    coordinates: dict[str, tuple] = {"domain": scalar(problem.domain, "bounded domain")}
    if problem.domain == "disc":
        axes: tuple[str, ...] = ("ring", "angle")
        place = described("particle position")
        coordinates |= {name: (axes, at, place) for name, at in problem.places.items()}
    else:
        axes = ("x", "y")[: problem.dim]
        lines = (at[:, 0] if n == 0 and at.ndim == 2 else at[0] if n else at
                 for n, at in enumerate(problem.places.values()))  # fmt: skip
        placed = zip(axes, lines, strict=True)
        coordinates |= {axis: along(axis, line, "particle position") for axis, line in placed}
    coordinates["volume"] = (axes, domain.volumes, described("particle volume V"))
    kind = {"interval": "graded particles", "square": "fitted lattice", "disc": "rings"}
    scheme = kind[str(problem.domain)]
    return Layout(axes, coordinates, lambda u: float((domain.volumes * u).sum()), scheme)


def to_dataset(
    problem: Problem,
    layout: Layout,
    u0: np.ndarray,
    result: Integration,
    estimates: dict[str, tuple[list[float], str]],
    origin: str,
) -> xr.Dataset:
    """Return u at t_final, or along t at each of `times`, with the cost of the solution and estimates of its error.

    Parameters
    ----------
    problem, layout, result
        The problem, its particles and its integration.
    u0 : array
        Initial strengths.
    estimates : dict
        By name: a value for each output time, and its meaning in words.
    origin : str
        Where the initial data come from, in words.
    """
    import xarray as xr

    several = problem.times is not None
    u = np.array([one.reshape(u0.shape) for one in result.u])
    mass = np.array([layout.integral(one) for one in u])
    first = ("t",) if several else ()

    def each(values: Any, meaning: str) -> tuple:
        values = np.asarray(values, dtype=float)
        return first, values if several else values[0], described(meaning)

    data = {
        "u": ((*first, *layout.axes), u if several else u[0], described("particle strength u")),
        "mass": each(mass, "total mass, the sum of V u"),
        "mass_initial": scalar(layout.integral(u0), "total mass, the sum of V u, at t_initial"),
        "mass_final": scalar(float(mass[-1]), "total mass, the sum of V u, at t_final"),
        "accepted_steps": scalar(np.int64(result.accepted), "number of time steps"),
        "evaluations": scalar(np.int64(result.evaluations), "number of evaluations of the right-hand side"),
        "stiffness": scalar(result.stiffness, "estimate of the largest eigenvalue times the time of the run"),
        **{name: each(values, meaning) for name, (values, meaning) in estimates.items()},
    }  # fmt: skip
    if result.rejected is not None:
        thrown = "number of time steps that were thrown away"
        data["rejected_steps"] = scalar(np.int64(result.rejected), thrown)
    coordinates = _coordinates(problem, layout, result.method)
    return xr.Dataset(data, coordinates, attrs=_attributes(problem, origin))


def _coordinates(problem: Problem, layout: Layout, integrator: str) -> dict[str, tuple]:
    """Return the places, the output times, and each parameter that is a number or a word."""
    fields = type(problem).model_fields
    given = {
        name: scalar(_plain(getattr(problem, name)), label_of(fields[name])) for name in _STORED
    }
    coefficients = {"beta": problem.order_coefficient, "diffusivity": problem.diffusion}
    constant = {
        name: scalar(one.constant, label_of(fields[name]))
        for name, one in coefficients.items()
        if one.constant is not None
    }
    ways = {
        "scheme": scalar(layout.scheme, "particle scheme"),
        "integrator": scalar(integrator, "time integrator"),
    }
    several = problem.times is not None
    times = {"t": along("t", problem.output_times, "output time")} if several else {}
    return given | constant | ways | layout.coordinates | times


def _attributes(problem: Problem, origin: str) -> dict[str, str]:
    return {
        "Conventions": "CF-1.11, ACDD-1.3",
        "title": f"Fractional diffusion, transport and source: u_t + div(a u) = {_diffusion(problem)} + f",
        "summary": "Particle strengths of one run and its parameters.",
        "keywords": "fractional diffusion, particle method, transport, reaction",
        "source": source(),
        "history": "fracparticles.solve_problem(problem, initial)",
        "references": "Lucchesi et al. (2020), doi:10.1007/s40571-019-00275-8",
        "initial_data": origin,
        "problem": problem.to_json(),
        "reproducible": "yes"
        if problem.reproducible
        else "no: a coefficient is a function, which no file holds",
    }


def _diffusion(problem: Problem) -> str:
    """Return the diffusion operator to which the form converges, in words."""
    if problem.order_coefficient.constant is None:
        return "-D (-Laplacian)^(alpha(x)/2) u"
    if problem.form == "exchange" and problem.diffusion.depends_on - {"t"}:
        return "(D L u + L(D u) - u L D) / 2" + " in the interior" * problem.is_bounded
    return "div(D grad^beta u)"


def _plain(value: Any) -> Any:
    return np.int64(value) if isinstance(value, int) else value
