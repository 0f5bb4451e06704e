"""Reaction: what is known of fronts, decay, sources and blow-up, on the smoke grid."""

from __future__ import annotations

import numpy as np
import pytest

from fracstudy.panels import pick


def test_the_front_gathers_speed_towards_its_rate(result):
    rates = pick(result.series, panel="rate", series="α = 1.5")
    exact = rates["exact"].iloc[0]
    assert exact == 0.4
    last = rates["y"].to_numpy()[-4:]
    assert (np.diff(last) > 0.0).all()
    assert last[-1] == pytest.approx(exact, rel=0.06)  # at t = 9; at t = 15 it is 0.3 per cent


def test_particles_follow_the_front_of_the_lattice(result):
    """The rates of both until t = 9, and from there on closer to the law."""
    lattice = pick(result.series, panel="rate", series="α = 1.5")
    followed = pick(result.series, panel="followed", series="α = 1.5")
    off = (1.0 - lattice["y"] / lattice["exact"]).abs().to_numpy()
    # At t = 3 and 4 half a spacing is much beside the place of the front.
    assert followed["y"].to_numpy()[2 : off.size] == pytest.approx(off[2:], abs=2e-3)
    assert followed["y"].iloc[-1] < 0.015
    counts = result.table.set_index("problem")["particles"]
    assert counts["Fisher-KPP, line, particles"] < 0.2 * counts["Fisher-KPP, line"]


def test_the_tail_is_the_power_of_the_diffusion(result):
    tail = pick(result.series, panel="front", series="3")
    far = tail[tail["x"] > 100.0]
    slope = np.polyfit(np.log(far["x"]), np.log(far["y"]), 1)[0]
    assert slope == pytest.approx(-2.5, abs=0.05)


def test_decay_has_the_exact_factor_to_the_tolerance(result):
    for integrator in ("dop853", "rkc2"):
        row = pick(result.table, problem="decay", integrator=integrator)
        assert row["error"].item() < 1e-5


def test_the_order_of_a_manufactured_solution_is_that_of_the_kernel(result):
    rows = pick(result.table, problem="manufactured source")
    assert rows["ours"].iloc[0] == pytest.approx(4.0, abs=0.1)
    assert rows["ours"].iloc[1] == pytest.approx(6.0, abs=0.1)


def test_blow_up_is_said_to_be_when_it_is(result):
    assert pick(result.table, problem="blow-up")["ours"].item() == pytest.approx(2.0, abs=1e-5)


def test_the_figure_has_its_panels(panels):
    assert len(panels) == 4
