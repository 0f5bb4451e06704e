"""Two cases, one file: never. Equal cases have equal paths, and only they."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from fracparticles.run.case import Case
from fracstudy.config import batches
from fracstudy.run_blocks import expand
from fracstudy.scene import Scene

GIVEN = {"scheme": "KPSE", "beta": 0.5, "half_width": 20.0, "spacing": 0.1, "dt": 1e-4}
GRADED = {"scheme": "GPSE", "dt": None, "graded_scale": 5.0}
DVM = {**GIVEN, "scheme": "DVM", "dt": 1e-3}


def case(**changes) -> Case:
    return Case(**{**GIVEN, **changes})


def same_run(one: Case, other: Case) -> bool:
    """Equal, where what is the default may be said or not: the integrator, and "series" where it is a series anyway."""

    def plain(c: Case) -> Case:
        evaluation = None if c._series_by_default else c.evaluation
        return c.model_copy(update={"integrator": c.resolved_integrator, "evaluation": evaluation})

    return plain(one) == plain(other)


def check(one: Case, other: Case) -> None:
    assert (one.path == other.path) == same_run(one, other)
    for c in (one, other):
        folder, beta, name = c.path.split("/")
        assert max(len(part.encode()) for part in (folder, beta, name)) <= 250
        assert name.endswith(".nc")
        assert c.path == Case.from_json(c.to_json()).path


@pytest.mark.parametrize(
    ("one", "other"),
    [
        ({"beta": 0.5}, {"beta": 0.50000001}),
        ({"beta": 0.1 + 0.2}, {"beta": 0.3}),
        ({"dt": 1e-4}, {"dt": 1.0000001e-4}),
        ({"initial": "a b.nc"}, {"initial": "a-b.nc"}),
        ({"initial": "a/b.nc"}, {"initial": "a-b.nc"}),
        ({"initial": "a%20b.nc"}, {"initial": "a b.nc"}),
        ({"initial": "ä.nc"}, {"initial": "a\u0308.nc"}),
        ({"initial": "a_naive"}, {"initial": "a", "summation": "naive"}),
        ({"initial": ""}, {"initial": "fundamental"}),
        ({"initial": "a" * 300}, {"initial": "a" * 301}),
        ({"initial": "a" * 300}, {"initial": "a" * 300, "store": "metrics"}),
        ({"t_initial": 0.5}, {"t_initial": np.nextafter(0.5, 1.0)}),
        ({"t_final": 1.5}, {"t_final": 1.5000001}),
        ({"half_width": 20.0}, {"half_width": 20.000001}),
        ({"half_width": None, "truncation": 20.0}, {"half_width": None, "truncation": 20.00000001}),
        ({"spacing": 0.1}, {"spacing": 0.10000000001}),
        ({"overlap": 2.0}, {"overlap": 2.0000001}),
        ({"diffusivity": 1.0}, {"diffusivity": 1.0000000001}),
        ({"diffusivity": 2.0}, {"diffusivity": 2.0000000001}),
        ({"kernel_table": 0.01}, {"kernel_table": 0.010000001}),
        (GRADED, {**GRADED, "graded_scale": 5.0000001}),
        (GRADED, {**GRADED, "graded_form": "exchange"}),
        (GRADED, {**GRADED, "graded_scale": None}),
    ],
    ids=str,
)
def test_cases_that_had_the_same_path(one, other):
    check(case(**one), case(**other))
    assert case(**one).path != case(**other).path


@pytest.mark.parametrize(
    "changes",
    [
        {"threshold": 1e-6},
        {"threshold": 1.0000001e-6},
        {"remesh_above": 1.2},
        {"remesh_above": 1.2000001},
    ],
)
def test_the_numbers_of_dvm(changes):
    paths = {
        Case(**DVM, **other).path
        for other in (
            {},
            changes,
            {name: 1e-3 + 1.1 * (name == "remesh_above") for name in changes},
        )
    }
    assert len(paths) == 3


def test_a_zero_has_no_sign():
    zeros = [case(t_initial=zero, initial="a.nc") for zero in (0.0, -0.0, 0)]
    assert zeros[0] == zeros[1] == zeros[2]
    assert len({c.path for c in zeros}) == 1
    assert Case(**DVM, threshold=0.0).path == Case(**DVM, threshold=-0.0).path


NUMBERS = st.sampled_from([0.25, 0.5, 0.1 + 0.2, 0.3, 1e-4]) | st.floats(1e-5, 0.9)
NAMES = st.text(max_size=12) | st.sampled_from(
    ["fundamental", "a" * 400, "ä" * 200, "a_b", "a%5Fb"]
)


@st.composite
def case_and_neighbour(draw) -> tuple[Case, Case]:
    """A case, and one that differs from it in no field, one or several: by a last digit, or by much."""
    fields = {
        "scheme": draw(st.sampled_from(["KPSE", "DD", "FPSE"])),
        "beta": draw(NUMBERS),
        "half_width": draw(st.sampled_from([20.0, 20.000001]) | st.floats(10.0, 30.0)),
        "spacing": draw(st.sampled_from([0.1, 0.3]) | st.floats(0.05, 1.0)),
        "dt": draw(NUMBERS),
        "t_initial": draw(st.sampled_from([0.0, -0.0, 0.5]) | NUMBERS),
        "t_final": draw(st.just(1.5) | st.floats(1.0, 2.0)),
        "diffusivity": draw(st.just(1.0) | NUMBERS),
        "overlap": draw(st.none() | st.floats(1.0, 3.0)),
        "initial": "x" + draw(NAMES),
        "summation": draw(st.sampled_from(["fft", "naive"])),
        "evaluation": draw(st.sampled_from([None, "series", "stepping"])),
        "integrator": draw(st.sampled_from([None, "rk2", "rk4"])),
        "kernel_table": draw(st.none() | st.floats(1e-3, 0.1)),
        "store": draw(st.sampled_from(["field", "profile", "metrics"])),
    }
    other = dict(fields)
    for name in draw(st.lists(st.sampled_from(sorted(fields)), max_size=2, unique=True)):
        value = other[name]
        if isinstance(value, float):
            ulps = draw(st.sampled_from([-1, 1, 1000, 10**8]))
            other[name] = min(max(value + ulps * math.ulp(value), 0.0), 1e3)
        elif name == "initial":
            other[name] = "x" + draw(NAMES)
        elif name == "evaluation":
            other[name] = draw(st.sampled_from([None, "series", "stepping"]))
        elif name == "integrator":
            other[name] = draw(st.sampled_from([None, "rk2", "rk4"]))
        elif name == "store":
            other[name] = draw(st.sampled_from(["field", "profile", "metrics"]))
    return Case(**fields), Case(**other)


@given(case_and_neighbour())
@example((case(), case()))
@example((case(evaluation="series"), case()))
@example((case(integrator="rk2"), case()))
def test_equal_cases_equal_paths_and_only_they(pair):
    check(*pair)


@given(NAMES, NAMES)
def test_names_of_files_are_told_apart(one, other):
    one, other = (case(initial=name) for name in (one, other))
    assert (one.path == other.path) == (one.initial == other.initial)
    assert one.path.isascii()
    assert one.path.count("/") == 2


def test_numbers_that_few_digits_say_are_written_as_before():
    c = Case(scheme="KPSE", order=4, beta=0.5, truncation=160.0, spacing=0.01117396, dt=5e-5)
    assert c.path == ("KPSE-4/beta0.5/C160_h0.01117396_rk2_dt5e-05_t0.5-1.5_truncated_field.nc")
    dvm = Case(scheme="DVM", beta=0.5, truncation=10.0, spacing=0.0447, dt=1e-3, remeshing="M4'")
    assert dvm.path == "DVM-2/beta0.5/C10_h0.0447_rk2_dt0.001_t0.5-1.5_M4-_truncated_field.nc"
    assert case(initial="a-b.nc", diffusivity=2.0).path.endswith(
        "t0.5-1.5_diffusivity2_from-a-b.nc_truncated_field.nc"
    )


def test_the_plan_makes_every_run_that_was_asked_for():
    block = {
        **GIVEN,
        "beta": [0.5, 0.50000001],
        "dt": [1e-4, 1.0000001e-4],
        "initial": ["a b.nc", "a-b.nc"],
    }
    assert len(expand([block])) == 8
    scene = Scene(name="one", folder=Path("one"), title="t", runs=[block])
    wanted, jobs = batches({"one": scene, "two": scene})
    computed = [c.path for chunk in jobs.values() for c in chunk]
    assert len(set(computed)) == len(computed) == 8
    assert {c.path for c in wanted["one"]} == {c.path for c in wanted["two"]} == set(computed)
