"""Graded particles through `Case`: the runs are the direct functions, and what cannot be is refused."""

from __future__ import annotations

import numpy as np
import pytest

import fracparticles as fp
from fracparticles.errors import AccuracyWarning, InvalidInput
from fracparticles.graded.field import GRADED_FORMS
from fracparticles.run.case import Case
from fracparticles.run.solver import prepare
from sweeps import covering, few

# As far as it takes for the tails: beta -> half-width and spacing in the middle, for L = 2.
GRIDS = {0.1: (1e10, 0.125), 0.5: (1e4, 0.2), 0.9: (300.0, 0.2)}
SCALE = 2.0


def case(beta: float = 0.5, **changes) -> Case:
    reach, spacing = GRIDS[beta]
    given = {"beta": beta, "half_width": reach, "spacing": spacing, "graded_scale": SCALE}
    return Case(**{"scheme": "GPSE", **given, **changes})


def test_the_particles_are_those_of_the_function():
    c = case()
    x, volumes = fp.graded_particles(c.particles, 1e4, SCALE)
    assert np.array_equal(c.x, x)
    assert np.array_equal(c.volumes, volumes)
    assert c.shape == x.shape
    assert c.particle_spacing == pytest.approx(volumes[c.n], rel=1e-14)
    assert c.particle_spacing == pytest.approx(0.2, rel=1.0 / c.n)


def test_any_number_of_particles_may_be_asked_for():
    h = 2.0 * SCALE * np.arcsinh(1e4 / SCALE) / 100.0
    assert case(spacing=h).particles == 101


def test_where_the_scale_is_large_the_particles_are_a_lattice():
    c = case(half_width=10.0, graded_scale=1e8)
    lattice = Case(scheme="GPSE", beta=0.5, half_width=10.0, spacing=0.2, dt=1.0)
    assert c.x == pytest.approx(lattice.x, rel=1e-13)
    u0 = np.exp(-(c.x**2))
    exchange = case(half_width=10.0, graded_scale=1e8, graded_form="exchange")
    assert prepare(exchange).solve(u0) == pytest.approx(prepare(lattice).solve(u0), abs=1e-13)


@pytest.mark.parametrize(("beta", "form"), covering([0.1, 0.5, 0.9], GRADED_FORMS))
def test_a_run_is_the_direct_function(beta, form):
    c = case(beta, graded_form=form, spacing=0.5, diffusivity=2.0, t_final=1.0)
    alpha = 1.0 + beta
    if form == "interpolated":
        matrix = fp.green_step_of_field(c.particles, c.half_width, SCALE, alpha, 1.0)
    else:
        particles = fp.graded_particles(c.particles, c.half_width, SCALE)
        matrix = fp.green_step(*particles, alpha, 1.0, form)
    u0 = fp.green(c.x, 2.0 * 0.5, alpha)
    run = fp.solve(c)
    rounding = u0.size * np.finfo(float).eps * (np.abs(matrix) @ u0)  # of a sum in another order
    assert (np.abs(run.u.values - matrix @ u0) <= rounding).all()
    assert run.mass_final.item() == pytest.approx(c.volumes @ (matrix @ u0), rel=1e-14)


@pytest.mark.parametrize("beta", few([0.1, 0.5, 0.9]))
def test_the_error_is_small(beta):
    """With nothing said of the form: the step of the field."""
    run = fp.solve(case(beta))
    exact = fp.green(run.x.values, 1.5, 1.0 + beta)
    near = np.abs(run.x.values) <= 5.0 * fp.mean_radius(1.0 + beta)
    assert run.u.values[near] == pytest.approx(exact[near], abs=1e-9 * exact.max())
    assert run.relative_l1_error.item() < 1e-9
    assert run.mass_initial.item() == pytest.approx(1.0, abs=1e-4)


def test_the_exchange_conserves():
    run = fp.solve(case(0.1, graded_form="exchange"))
    assert run.mass_final.item() == pytest.approx(run.mass_initial.item(), rel=1e-13)


def test_the_data_set(tmp_path):
    run = fp.solve(case())
    fp.write(run, tmp_path / "run.nc")
    back = fp.read_run(tmp_path / "run.nc")
    assert back.identical(run)
    assert Case.from_json(back.attrs["case"]) == case()
    assert np.array_equal(back.x, case().x)
    assert back.mass_final.item() == pytest.approx(float((back.volume * back.u).sum()), rel=1e-14)
    values = {"graded_scale": SCALE, "graded_form": "interpolated", "summation": "matrix"}
    values |= {"integrator": "euler", "dt": 1.0, "exterior": "truncated", "half_width": 1e4}
    assert {name: back[name].item() for name in values} == values
    for name, variable in back.variables.items():
        assert variable.attrs["long_name"], name
    assert {"resolution", "growth", "outside_share"} <= set(back.data_vars)
    assert not {"wave_error", "decay", "round_off", "tail_misfit"} & set(back.data_vars)


@pytest.mark.parametrize(("store", "kept"), [("profile", {"u", "volume"}), ("metrics", set())])
def test_what_a_data_set_keeps(store, kept):
    run = fp.solve(case(store=store))
    assert {name for name, part in run.data_vars.items() if part.ndim} == kept
    assert run.relative_l1_error.item() == fp.solve(case()).relative_l1_error.item()


def test_a_lattice_has_no_grading_in_its_data_set():
    run = fp.solve(Case(scheme="GPSE", beta=0.5, half_width=10.0, spacing=0.25, dt=1.0))
    assert not {"graded_scale", "graded_form", "volume"} & set(run.variables)
    assert "graded" not in run.attrs["case"]


def test_a_run_goes_on_where_another_ended():
    whole = fp.solve(case())
    half = fp.solve(case(t_final=1.0))
    rest = fp.solve(case(t_initial=1.0), half.isel(x=slice(None, None, -1)))
    near = np.abs(whole.x.values) <= 10.0
    assert rest.u.values[near] == pytest.approx(whole.u.values[near], abs=1e-12)
    with pytest.raises(InvalidInput, match=r"initial = .*points are up to"):
        fp.solve(case(t_initial=1.0, graded_scale=2.001), half)


def test_data_of_ones_own():
    run = fp.solve(case(), lambda x: np.exp(-x * x))
    assert run.mass_initial.item() == pytest.approx(np.sqrt(np.pi), rel=1e-12)
    assert "relative_l1_error" not in run
    ready = prepare(case())
    assert ready.operator_applications == 1
    u0 = np.exp(-(case().x ** 2))
    assert np.array_equal(ready.solve(u0), run.u)
    u0[3] = np.nan
    with pytest.raises(InvalidInput, match="not finite at x = -"):
        ready.solve(u0)
    with pytest.raises(fp.NonFiniteSolution, match="GPSE"):
        prepare(case(graded_form="quadrature")).solve(np.full(case().shape, 1e308))


def test_too_narrow_is_a_warning():
    with pytest.warns(AccuracyWarning, match="does not fit") as given:
        fp.solve(case(half_width=2.0, spacing=0.05))
    assert all("open" not in str(one.message) for one in given)
    with pytest.warns(AccuracyWarning, match="do not resolve"):
        fp.solve(case(spacing=1.5), lambda x: np.exp(-4.0 * x * x))


@pytest.mark.parametrize(("changes", "field", "words"), [
    ({"dt": 1.0}, "dt", "nothing for graded particles"),
    ({"overlap": 2.0}, "overlap", "nothing for graded particles"),
    ({"dim": 2}, "dim", "1 for graded particles"),
    ({"exterior": "open"}, "exterior", "truncated for graded particles"),
    ({"summation": "naive"}, "summation", "fft for graded particles"),
    ({"scheme": "KPSE"}, "scheme", "GPSE for graded particles"),
    ({"scheme": "DVM", "dt": 0.1}, "scheme", "GPSE for graded particles"),
    ({"evaluation": "series"}, "evaluation", "nothing for graded particles"),
    ({"kernel_table": 0.01}, "kernel_table", "nothing for graded particles"),
    ({"integrator": "rk2"}, "integrator", "nothing or 'euler'"),
    ({"order": 4}, "order", "2 for GPSE"),
    ({"graded_scale": None, "graded_form": "exchange"}, "graded_form", "particles on a lattice"),
    ({"graded_scale": 0.0}, "graded_scale", "a number between"),
    ({"graded_form": "field"}, "graded_form", "one of exchange, quadrature, interpolated"),
    ({"spacing": 10.0}, "spacing", "at most an eighth of L arcsinh(D / L)"),
    ({"spacing": 1e-3}, "spacing", "at least"),
    ({"half_width": None}, "truncation", "exactly one of truncation and half_width"),
    ({"half_width": None, "truncation": 1e100, "t_final": 1e90}, "truncation", "a half-width from"),
])  # fmt: skip
def test_what_cannot_be_is_refused(changes, field, words):
    with pytest.raises(InvalidInput) as refused:
        case(**changes)
    assert refused.value.field == field
    assert words in str(refused.value)
