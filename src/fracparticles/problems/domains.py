"""Problems on bounded domains: which fields they have, which values fit together, and their particles.

On an interval, a square or a disc there is no lattice. `particles` gives the number of particles, and `exterior` says
what u is outside. On the interval a diffusivity that varies in space may have the flux form div(D grad^beta u)
(form="FPSE"). On every domain it may have the exchange with the mean of a pair (form="exchange"), which conserves.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from fracparticles.bounded.disc import Disc
from fracparticles.bounded.domain import EXTERIORS, Domain
from fracparticles.bounded.interval import Interval
from fracparticles.bounded.square import Square
from fracparticles.errors import InvalidInput, one_of
from fracparticles.problems.coefficients import WithCoefficients

__all__ = [
    "DOMAINS",
    "OF_A_LATTICE",
    "check_domain",
    "is_bounded",
    "make_domain",
    "sample_points",
    "with_dim",
]

DOMAINS = ("interval", "square", "disc")
# Particles on the interval, or along a side of the square, or rings of the disc: the default, the fewest and the most.
_USUAL = {"interval": 200, "square": 64, "disc": 64}
_RANGE = {"interval": (16, 4000), "square": (8, 512), "disc": (8, 128)}
OF_A_LATTICE = ("spacing", "order", "overlap", "far_terms")
_NORMAL = 1e-9  # share of the greatest velocity that may point through an edge that nothing leaves
# Particles in a disc with a diffusivity that varies: all its modes are those of one matrix.
_MOST = 2100


def is_bounded(exterior: str) -> bool:
    """Return whether an exterior is that of a bounded domain."""
    return exterior in EXTERIORS


def with_dim(fields: dict[str, Any]) -> dict[str, Any]:
    """Return the fields with the dimension and the domain that follow from the others."""
    domain, exterior, dim = fields.get("domain"), fields.get("exterior"), fields.get("dim", 1)
    if isinstance(domain, str) and domain in ("square", "disc"):
        fields.setdefault("dim", 2)
    # Nothing is checked yet: each may be anything.
    elif isinstance(exterior, str) and exterior in EXTERIORS and isinstance(dim, int) and dim == 1:
        fields.setdefault("domain", "interval")
    return fields


def sample_points(domain: str | None, half_width: float, dim: int) -> tuple[np.ndarray, ...]:
    """Return some points of the domain: at its edge, in its middle and between them."""
    axis = np.linspace(-half_width, half_width, 257 if dim == 1 else 33)
    if domain != "disc":
        return tuple(np.meshgrid(*(axis,) * dim, indexing="ij", sparse=True))
    radius, angle = np.linspace(0.0, half_width, 17)[:, None], np.linspace(0.0, 2.0 * np.pi, 33)
    return radius * np.cos(angle), radius * np.sin(angle)


def make_domain(problem: WithCoefficients) -> Domain:
    """Return the particles of a problem on a bounded domain, of diffusivity 1."""
    alpha, half, exterior = 1.0 + problem.beta, problem.half_width, problem.exterior
    domain = str(problem.domain)
    count = problem.particles or _USUAL[domain]
    if domain == "interval":
        return Interval(alpha=alpha, particles=count, ends=(-half, half), exterior=exterior)
    if domain == "square":
        return Square(alpha, count, exterior, half_width=half)
    # The number of angles is even, and as great as the ring at half the radius has room for.
    return Disc(alpha, count, 2 * (max(8, count // 2) // 2), exterior, radius=half)


def check_domain(problem: WithCoefficients, looks: np.ndarray) -> None:
    """Refuse fields of a lattice on a domain, fields of a domain on a lattice, and values that do not fit together.

    Parameters
    ----------
    problem : WithCoefficients
    looks : array
        Times at which a velocity that depends on time is evaluated.

    Raises
    ------
    InvalidInput
        If one of these is given; says what is allowed.
    """
    given = problem.model_fields_set
    if not is_bounded(problem.exterior):
        for name in ("domain", "particles", "exterior_data"):
            if getattr(problem, name) is not None:
                what = f"nothing where the exterior is {problem.exterior}"
                remedy = "Leave it out, or take exterior='absorbing', 'reflecting' or 'given'."
                raise InvalidInput(name, getattr(problem, name), what, remedy)
        if problem.spacing is None:
            raise InvalidInput("spacing", None, "a number", "Give the particle spacing h.")
        return
    for name in OF_A_LATTICE:
        if name in given and getattr(problem, name) is not None:
            what = "nothing on a bounded domain, whose particles are no lattice of the scheme"
            raise InvalidInput(name, getattr(problem, name), what, "Leave it out; give particles.")
    fits = DOMAINS[:1] if problem.dim == 1 else DOMAINS[1:]
    if problem.domain not in fits:
        raise one_of("domain", problem.domain, fits, f"dim = {problem.dim}")
    low, high = _RANGE[str(problem.domain)]
    if problem.particles is not None and not low <= problem.particles <= high:
        what = f"a whole number from {low} to {high} on the {problem.domain}"
        raise InvalidInput("particles", problem.particles, what, "Give such a number.")
    if (problem.exterior_data is None) == (problem.exterior == "given"):
        what = "values of u outside if the exterior is given, nothing otherwise"
        raise InvalidInput("exterior_data", problem.exterior_data, what, "Mend one of the two.")
    if problem.order_coefficient.constant is None:
        what = "a number on a bounded domain"
        raise InvalidInput("beta", problem.beta, what, "Give beta = alpha - 1, or alpha itself.")
    if problem.integrator != "auto" and problem.domain != "square":
        what = f"auto on the {problem.domain}, where the modes of the diffusion are known"
        raise InvalidInput("integrator", problem.integrator, what, "Leave it out.")
    _check_form(problem)
    if problem.exterior == "reflecting" and problem.transport:
        _check_edge(problem, looks)


def _check_form(problem: WithCoefficients) -> None:
    form, varies = problem.form, bool(problem.diffusion.depends_on - {"t"})
    if form == "DD":
        raise one_of("form", form, ("FPSE", "exchange"), "a bounded domain")
    if not varies or form == "exchange":
        if varies and problem.domain == "disc" and _size(problem) > _MOST:
            what = f"64 or fewer rings with a diffusivity that varies, {_MOST} particles in all"
            raise InvalidInput("particles", problem.particles, what, "Take fewer.")
        return
    remedy = "Take form='exchange', another equation, or leave the place out of the diffusivity."
    if problem.exterior == "reflecting":
        what = "exchange for a diffusivity that varies where nothing leaves: the flux of the interior alone is no flux"
        raise InvalidInput("form", form, what, remedy)
    if problem.dim == 2:
        what = (
            "exchange for a diffusivity that varies in the plane, where the flux form is not there"
        )
        raise InvalidInput("form", form, what, remedy)


def _size(problem: WithCoefficients) -> int:
    return int(make_domain(problem).volumes.size)


def _check_edge(problem: WithCoefficients, looks: np.ndarray) -> None:
    """Refuse a velocity through an edge that nothing leaves."""
    points = sample_points(problem.domain, problem.half_width, problem.dim)
    for t in looks if any("t" in one.depends_on for one in problem.transport) else looks[:1]:
        a = [_sampled(one, points, t) for one in problem.transport]
        fastest = max(float(np.abs(part).max()) for part in a)
        for place, through in _through(problem.domain, a):
            if np.abs(through).max(initial=0.0) > _NORMAL * fastest:
                shown = f"{np.abs(through).max():.3g} through the edge at t = {t:g}"
                what = f"a field along the {place}, where nothing leaves"
                raise InvalidInput("velocity", shown, what, "Let it vanish there.")


def _sampled(one: Callable[..., Any], points: tuple[np.ndarray, ...], t: float) -> np.ndarray:
    named = dict(zip(("x", "y"), points, strict=False))
    return np.asarray(one({**named, "t": np.array(t)}))


def _through(domain: str | None, a: list[np.ndarray]) -> Iterator[tuple[str, np.ndarray]]:
    """Yield the places of the edge, and the part of a velocity at `sample_points` that points through it."""
    if domain == "interval":
        yield "ends, zero there", a[0][[0, -1]]
    elif domain == "square":
        yield "edges", a[0][[0, -1], :]
        yield "edges", a[1][:, [0, -1]]
    else:
        angle = np.linspace(0.0, 2.0 * np.pi, a[0].shape[1])
        yield "edge", a[0][-1] * np.cos(angle) + a[1][-1] * np.sin(angle)
