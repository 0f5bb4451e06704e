"""Cases that can be run: plausible ones, with whatever fields go with them, and data for them."""

from typing import Any

import numpy as np
from hypothesis import assume
from hypothesis import strategies as st

from fracparticles.errors import InvalidInput
from fracparticles.run.case import Case
from fracparticles.schemes import ALL_SCHEMES
from scenes.extremes.fuzzing.harness import NotRun
from scenes.extremes.fuzzing.strategies import among, between, chance, fields_of

_MOST_INTERVALS = {1: 30, 2: 9, 3: 8}  # half of them, on either side
_DEAREST = 3e7  # additions of naive sums: a second
_REPAIRS = 25
_BETAS = (1e-9, 1e-3, 0.02, 0.98, 1.0 - 1e-3, 1.0 - 1e-9)
# Of lengths and times: mostly one.
_UNITS = (1.0, 1.0, 1.0, 1.0, 1e-6, 1e6, 1e-30, 1e30, 1e-90, 1e90)


@st.composite
def cases(draw: st.DrawFn, share: int = 15, **wanted: Any) -> Case:
    """Draw a case that is allowed: a plausible one, and any other field in `share` per cent.

    A field that is refused is left out or drawn again, as the refusal says.
    """
    given = _plausible(draw, wanted) | wanted
    for name, values in fields_of(Case).items():
        if name not in given and name != "initial" and draw(chance(share)):
            given[name] = draw(values)
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
    dim = wanted.get("dim") or draw(st.sampled_from((1,) * 5 + ALL_SCHEMES[scheme].dims))
    length, rate = draw(st.sampled_from(_UNITS)), draw(st.sampled_from(_UNITS))
    width = draw(among(1.0, 4.0, 10.0, 30.0, 100.0))
    time = length ** (1.0 + beta) / rate
    start = draw(among(0.1, 0.5, 1.0, 5.0)) * time
    span = draw(among(1e-3, 0.1, 1.0, 1.0, 3.0)) * time
    half_width = width * length
    assume(dim in ALL_SCHEMES[scheme].dims and all(1e-99 < x < 1e99 for x in (start, span, time)))
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
    if case.is_graded:
        pairs, applications = float(case.particles) ** 2, 1.0
    elif case.dim == 3 and case.resolved_overlap < 0.8:
        raise NotRun("many aliases")
    else:
        pairs = float(case.particles) ** (2 if case.summation == "naive" else 1)
        if case.kind.moving:  # one by one, with many that stand for what is beyond
            pairs *= 0.1 * case.resolved_overlap**2
        if case.kernel_table and 2.0 * case.n / case.resolved_overlap > 1e5 * case.kernel_table:
            raise NotRun("a long table")
        stiffness = case.span * case.setting.rate * max(map(abs, case.symbol_range))
        applications = 4.0 * case.steps if case.steps_taken else 10.0 + 10.0 * stiffness**0.5
        if case.evaluation == "convolution":
            applications = 10.0
    if case.particles > 20_000 or applications > 2e4 or pairs * applications > _DEAREST:
        raise NotRun(f"{case.particles} particles, {applications:.0f} applications")
    return case


def as_given(case: Case) -> dict[str, Any]:
    """Return the fields of the case that were given."""
    given = case.model_fields_set  # a set, whose order differs from process to process
    return {name: getattr(case, name) for name in Case.model_fields if name in given}


def changed(case: Case, **fields: Any) -> Case:
    """Return the case with other values of some fields."""
    return Case(**as_given(case) | fields)


KINDS = ("noise", "noise", "spike", "tiny", "huge", "constant", "zero")


def rough(case: Case, seed: int, kind: str = "noise") -> np.ndarray:
    """Return strengths that no solution has; positive ones for particles that move."""
    shape, random = case.shape, np.random.default_rng(seed)
    if case.kind.moving:  # whose velocity is a quotient of fields
        x = case.x / case.reach
        return np.exp(-9.0 * (x - random.uniform(-0.2, 0.2)) ** 2) + 0.01
    if kind == "spike":
        u = np.zeros(shape)
        u[tuple(random.integers(0, size) for size in shape)] = 1.0
        return u
    if kind in ("constant", "zero"):
        return np.full(shape, float(kind == "constant"))
    size = {"tiny": 1e-300, "huge": 1e300}.get(kind, 1.0)
    return size * random.uniform(-1.0, 1.0, shape)


def runs(**wanted: Any) -> st.SearchStrategy[tuple[Case, np.ndarray]]:
    """Draw a case that can be run here, and data for it."""
    drawn = st.tuples(cases(**wanted), st.integers(0, 10**6), st.sampled_from(KINDS))
    return drawn.map(lambda parts: (parts[0], rough(*parts)))
