"""Transport: which way is exact to what, on the smoke grid."""

from __future__ import annotations

import pytest

from fracstudy.panels import pick


def test_the_lattice_has_the_order_of_its_kernel_in_a_uniform_field(result):
    row = pick(result.table, field="uniform", way="lattice, order 4", h=0.2)
    assert row["observed order"].item() == pytest.approx(4.0, abs=0.1)


def test_the_lattice_is_more_accurate_than_moving_particles(result):
    fine = pick(result.table, h=0.2)
    for _, part in fine.groupby("field"):
        error = part.set_index("way")["error"]
        # Of a uniform field nothing but the remeshing is left, whose smoothest function comes near.
        assert error["lattice, order 12"] < 0.1 * error.filter(like="particles").min()


def test_moving_particles_have_the_order_of_the_remeshing_where_the_splitting_is_exact(result):
    for name, order in (("Lambda3", 4.0), ("M4'", 3.0)):
        row = pick(result.table, field="uniform", way=f"particles, {name}", h=0.2)
        assert row["observed order"].item() == pytest.approx(order, abs=0.2)


def test_the_linear_field_keeps_the_stable_law(result):
    shown = pick(result.series, panel="linear field")
    for time in ("0.25", "4"):
        exact, ours = (pick(shown, series=f"{who}, t = {time}")["y"] for who in ("exact", "ours"))
        # Of order 12 at h = 0.2; the ends of the lattice leave about as much.
        assert ours.to_numpy() == pytest.approx(exact.to_numpy(), abs=1e-5)


def test_the_figure_has_its_panels(panels):
    assert len(panels) == 4
