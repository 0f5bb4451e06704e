"""DVM in the plane beside the line, on the smoke grid."""

from __future__ import annotations

from fracstudy.panels import pick

PARAMETERS = {"half_width": 4.0}


def test_the_total_is_kept_or_counted(result):
    assert pick(result.table, dim=2)["drift below"].max() < 1e-12


def test_without_remeshing_the_order_is_that_of_the_kernels(result):
    rows = pick(result.table, remeshing="none").dropna(subset=["observed order"])
    second, fourth = (pick(rows, order=order)["observed order"] for order in (2, 4))
    assert (second - 2.0).abs().max() < 0.1
    assert fourth.min() > 3.9  # on lattices as coarse as these it is more


def test_a_smooth_remeshing_adds_nothing_to_the_error(result):
    rows = pick(result.table, dim=2, order=4, h=0.2).set_index(["remeshing", "exterior"])["error"]
    for exterior in ("truncated", "open"):
        assert rows["Lambda6,4", exterior] < 1.1 * rows["none", "open"]


def test_the_figure_has_its_panels(panels):
    assert len(panels) == 4
