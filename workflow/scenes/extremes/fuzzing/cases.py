"""Cases that can be run: plausible ones, with whatever fields go with them, and data for them."""

from __future__ import annotations

from typing import Any

import numpy as np
from hypothesis import assume
from hypothesis import strategies as st

from fracparticles.errors import InvalidInput
from fracparticles.run.case import Case
from fracparticles.schemes import ALL_SCHEMES
from scenes.extremes.fuzzing.harness import NotRun
from scenes.extremes.fuzzing.strategies import between, chance, value_of

__all__ = ["cases", "fields_of", "refuse_dear", "rough", "runs"]

_MOST_INTERVALS = {1: 50, 2: 10, 3: 8}  # half of them, on either side
_DEAREST = 3e8  # additions of naive sums: a second
_REPAIRS = 25
_BETAS = (1e-9, 1e-3, 0.02, 0.98, 1.0 - 1e-3, 1.0 - 1e-9)
# Of lengths and times: mostly one.
_UNITS = (1.0, 1.0, 1.0, 1.0, 1e-6, 1e6, 1e-30, 1e30)


@st.composite
def cases(draw: st.DrawFn, share: int = 15, **wanted: Any) -> Case:
    """Draw a case that is allowed: a plausible one, and any other field in `share` per cent.

    A field that is refused is left out or drawn again, as the refusal says.
    """
    given = _plausible(draw, wanted) | wanted
    for name, field in Case.model_fields.items():
        if name not in given and name != "initial" and draw(chance(share)):
            given[name] = draw(value_of(field))
    for _ in range(_REPAIRS):
        try:
            return Case(**given)
        except InvalidInput as refusal:
            name = refusal.field
        assume(name not in wanted)
        if name == "half_width":  # too narrow for the solution
            given["half_width"] *= 4.0
            given["spacing"] *= 4.0
        elif name == "dt" and "dt" not in given:
            steps = draw(st.integers(1, 30))
            given["dt"] = (given["t_final"] - given["t_initial"]) / steps
        elif name == "scheme":  # of what goes with another one
            for other in ("graded_scale", "evaluation"):
                given.pop(other, None)
        elif name in ("t_final", "spacing"):
            given |= _plausible(draw, wanted) | wanted
        elif name in given:
            del given[name]
        else:
            assume(False)
    assume(False)
    raise AssertionError


def _plausible(draw: st.DrawFn, wanted: dict[str, Any]) -> dict[str, Any]:
    """Draw the fields that make a case: a lattice some times as wide as the solution, in any units."""
    scheme = wanted.get("scheme") or draw(st.sampled_from(sorted(ALL_SCHEMES)))
    beta = draw(st.one_of(between(0.05, 0.95), between(0.05, 0.95), st.sampled_from(_BETAS)))
    dim = wanted.get("dim") or draw(st.sampled_from((1, 1, 1, *ALL_SCHEMES[scheme].dims)))
    length, rate = draw(st.sampled_from(_UNITS)), draw(st.sampled_from(_UNITS))
    width = draw(st.sampled_from((1.0, 4.0, 10.0, 30.0, 100.0)))
    time = length ** (1.0 + beta) / rate
    start = draw(st.sampled_from((0.1, 0.5, 1.0, 5.0))) * time
    span = draw(st.sampled_from((1e-3, 0.1, 1.0, 1.0, 3.0))) * time
    half_width = width * length
    assume(dim in ALL_SCHEMES[scheme].dims and all(1e-90 < x < 1e90 for x in (start, span, time)))
    fields = {
        "scheme": scheme,
        "beta": beta,
        "dim": dim,
        "half_width": half_width,
        "spacing": half_width / draw(st.integers(8, _MOST_INTERVALS[dim])),
        "diffusivity": rate,
        "t_initial": start,
        "t_final": start + span,
    }
    kind = ALL_SCHEMES[scheme]
    fields["order"] = draw(st.sampled_from(kind.orders if dim == 1 else kind.box_orders))
    fields["exterior"] = draw(st.sampled_from(kind.exteriors))
    if draw(st.booleans()):
        fields["integrator"] = "exponential"
        if fields["exterior"] == "open" and draw(chance(25)):
            fields["evaluation"] = "convolution"
    elif draw(chance(80)):
        fields["dt"] = span / draw(st.integers(1, 30))
    return fields


def refuse_dear(case: Case) -> Case:
    """Return the case if it can be run here in a second or so."""
    power = 2 if case.summation == "naive" or case.is_graded else 1
    stiffness = case.span * case.setting.rate
    applications = 4 * case.steps if case.steps_taken else 10.0 + stiffness**0.5 * 10.0
    if case.evaluation == "convolution":
        applications = 10.0
    if case.particles > 20_000 or float(case.particles) ** power * applications * 10.0 > _DEAREST:
        raise NotRun(f"{case.particles} particles, {applications:.0f} applications")
    return case


def fields_of(case: Case) -> dict[str, Any]:
    """Return the fields that were given."""
    return {name: getattr(case, name) for name in case.model_fields_set}


def rough(case: Case, seed: int, kind: str = "noise") -> np.ndarray:
    """Return strengths that no solution has."""
    shape, random = case.shape, np.random.default_rng(seed)
    if kind == "spike":
        u = np.zeros(shape)
        u[tuple(random.integers(0, size) for size in shape)] = 1.0
        return u
    if kind == "tiny":
        return 1e-300 * random.standard_normal(shape)
    if kind == "huge":
        return 1e300 * random.standard_normal(shape)
    if kind == "constant":
        return np.ones(shape)
    return random.standard_normal(shape)


def runs(**wanted: Any) -> st.SearchStrategy[tuple[Case, np.ndarray]]:
    """Draw a case and data for it."""
    kinds = ("noise", "noise", "spike", "tiny", "huge", "constant")
    drawn = st.tuples(cases(**wanted), st.integers(0, 10**6), st.sampled_from(kinds))
    return drawn.map(lambda parts: (parts[0], *parts[1:]))
