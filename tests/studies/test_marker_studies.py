"""The marker studies on tiny grids: every claim answered, every figure drawn, and the maths inside."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from fracparticles.markers import SHAPES, Square
from fracparticles.markers.stability import rate
from fracparticles.moving.lagrangian import FieldNotPositive
from fracstudy.claims import Status, judge, read_claims
from fracstudy.inputs import Inputs
from scene_functions import figure, study
from scenes.lewandowski.marker_claims.study import quadrature_exponent, smoothing_exponent
from scenes.lewandowski.marker_growth.study import largest_step, measured_rate
from scenes.lewandowski.marker_runs import cluster_centres, delay, emptiness, load, spectrum, trace

CLAIMS = {
    claim.id: claim
    for claim in read_claims(Path(__file__).parents[2] / "report/printed/lewandowski2005.yaml")
}
RUN = {"support": 1.0, "dt": 0.05, "t_final": 0.5, "markers": 48, "half_width": 14.0, "grid": 120}
RANDOM = {**RUN, "seed": 2005, "seeds": 2, "gap": 0.2, "within": 3.0}
SCENES = {
    "marker_shapes": (["M-SHAPES"], {"wavenumbers": 20.0}),
    "marker_loading": (
        ["M-F1", "M-F2", "M-F3", "M-F4"],
        {"support": 0.1, "markers": 32, "ends": [2.0, 4.0, 5], "tabled": [3.0], "shown": 3.0},
    ),
    "marker_square": (
        ["M-F5", "M-F6", "M-F7"],
        {**RUN, "dt": 0.02, "t_final": 0.1, "seed": 1, "supports": [0.5], "shown": [0.2, 2.0, 1.0]},
    ),
    "marker_fixed_grid": (["M-F8", "M-F9", "M-F10"], RANDOM),
    "marker_moving_grid": (["M-F11", "M-F12", "M-F13"], {**RANDOM, "compared": ["S2", "S5"]}),
    "marker_error_norm": (["M-F14", "M-F15", "M-F16"], {**RANDOM, "long": {**RUN, "t_final": 1.0}}),
    "marker_growth": (
        ["M-C1"],
        {
            **RUN,
            "lattices": {"S4": {"spacing": 0.125, "period": 4.0, "amplitude": 1e-4, "modes": [2, 4]}},
            "wavenumbers": 13.0,
            "limits": {"shapes": ["S4"], "supports": [1.0]},
            "steps": [0.05, 1.25],
            "t_final": 1.25,
        },
    ),
    "marker_claims": (
        ["M-C2", "M-C3", "M-C4", "M-C5"],
        {
            **RANDOM,
            "small_dt": 0.025,
            "watched": 0.2,
            "counts": [16, 32],
            "shapes": ["S4", "S8"],
            "law": ["S4", "S8"],
            "spacings": [0.4],
            "times": [0.25, 0.5],
        },
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", SCENES)
def test_every_claim_is_answered_and_the_figure_drawn(name):
    items, parameters = SCENES[name]
    result = study(name)(Inputs("scene", items, parameters, printed={}))
    answered = sorted(finding.claim for finding in result.findings)
    assert answered == sorted(key for key, claim in CLAIMS.items() if claim.item in items)
    for finding in result.findings:
        assert finding.reason or not judge(CLAIMS[finding.claim], finding)[0].needs_reason
    assert len(result.table)
    figure(name)(result.series, result.table, dict(parameters)).draw_without_rendering()


def test_two_printed_constants_are_wrong():
    items, parameters = SCENES["marker_shapes"]
    result = study("marker_shapes")(Inputs("scene", items, parameters))
    refuted = {f.claim for f in result.findings if judge(CLAIMS[f.claim], f)[0] is Status.REFUTED}
    assert refuted == {"M-SHAPES.beta", "M-SHAPES.alpha"}


def test_the_growth_is_called_unbounded_where_it_is():
    """-k^2 S^(k) of the gate is -k sin k; of the others it falls, or nears twice the slope at the end."""
    items, parameters = SCENES["marker_shapes"]
    table = study("marker_shapes")(Inputs("scene", items, parameters)).table.set_index("S")
    assert list(table.index[table["beyond"] == "unbounded"]) == ["S1"]
    largest = table["largest growth × ε², k < 30"]
    # The highest wave below 30 ends at 3 pi / 2 + 8 pi, its top is where tan k = -k.
    assert largest["S1"] == pytest.approx(29.8618, abs=1e-3)
    for waves in (10, 100, 1000):
        k = np.array((2.0 * waves + 1.5) * np.pi)
        assert rate(SHAPES["S1"], k) == pytest.approx(k, rel=1e-9)
    beyond = np.linspace(30.0, 1000.0, 20001)
    for name in table.index.drop("S1"):
        # The transform is good to 1e-14, its product with k^2 to 1e-8.
        assert rate(SHAPES[name], beyond).max() <= largest[name] + 1e-7, name


def test_clusters_of_known_places():
    centres = np.array([-2.0, -1.0, 0.0, 1.0, 2.0])
    x = (centres[:, None] + 0.01 * np.array([-1.0, 0.0, 1.0])).ravel()
    assert cluster_centres(x, 0.2, 3.0) == pytest.approx(centres, abs=1e-14)
    # The gaps: 4 of 0.98 between the clusters, 0.99 at each end of 6.
    assert emptiness(x, 0.2, 3.0) == pytest.approx((4 * 0.98 + 2 * 0.99) / 6.0, rel=1e-12)
    assert emptiness(np.linspace(-3.0, 3.0, 100), 0.2, 3.0) == 0.0
    assert cluster_centres(np.array([0.0, 1.0, 2.0]), 0.2, 3.0).size == 0


def test_the_spectrum_tells_clusters_from_order():
    k = np.linspace(3.0, 12.0, 91)
    clusters = np.repeat(np.arange(-8.0, 9.0), 5)
    peak = k[np.argmax(spectrum(clusters, k, 8.0))]
    assert peak == pytest.approx(2.0 * np.pi, abs=0.1)  # the step of k
    even = np.linspace(-8.0, 8.0, 801)
    # sin(k w) / k terms of a smooth window: far below 1 once k times its width is large.
    assert spectrum(even, k, 8.0).max() < 1e-3


def test_a_delayed_solution_is_recognised():
    grid = np.linspace(-12.0, 12.0, 201)
    tau, left = delay(grid, Square().value(grid, 3.7), 4.0)
    assert tau == pytest.approx(0.3, abs=1e-4)  # the tolerance of the minimisation, 1e-5
    assert left < 1e-3


def test_the_readings_of_the_start():
    x, weights = load("midpoints", 8)
    assert x == pytest.approx(np.arange(-7.0, 8.0, 2.0) / 8.0, abs=1e-15)
    assert weights == pytest.approx(np.full(8, 0.25))
    x, weights = load("wide", 256, half_width=14.0)
    assert x.size == 18  # 2 / (28 / 256), cells whose middle lies inside
    assert np.abs(x).max() <= 1.0


def test_a_run_can_be_judged_at_its_end_only():
    followed = trace(RUN, "S8", "midpoints")
    end = trace(RUN, "S8", "midpoints", follow=False)
    assert followed.t.size == 11
    assert end.t == pytest.approx([0.5])
    assert end.error[-1] == followed.error[-1]


def test_a_run_that_stops_says_so():
    # A marker far ahead of the others comes to where S8 of all the rest is negative.
    found = trace(
        {**RUN, "dt": 0.0125, "t_final": 1.0, "markers": 256, "grid": 10}, "S8", "random", 2005
    )
    assert found.run is None
    assert "step 75 of 80, from t = 0.925 to 0.9375: the field is" in found.stopped
    assert found.t[-1] == pytest.approx(0.925)
    with pytest.raises(FieldNotPositive, match="random"):
        _ = found.end


def test_measured_rates_are_the_predicted_ones():
    k, growth = measured_rate("S8", 4, 0.25, 16.0, 1e-6, 0.005, 4)
    # -k^2 S^ of S8; the midpoint rule errs by (rate dt)^2 / 6 relative.
    expected = -k * k * (1.0 + 0.25 * k * k) * np.exp(-0.25 * k * k)
    assert growth == pytest.approx(expected, rel=(expected * 0.005) ** 2)


def test_the_largest_step_is_that_of_the_transform():
    # 12 halvings of [0.05, 2]: 5e-4.
    assert largest_step("S8", 1.0) == pytest.approx(0.5952649, abs=5e-4)


@pytest.mark.parametrize(("name", "k", "m"), [("S1", 2, 1), ("S3", 2, 2), ("S8", 4, None)])
def test_exponents_of_the_error_law(name, k, m):
    # eps^2 corrections: eps = 0.2 against a width of 1.
    assert smoothing_exponent(SHAPES[name]) == pytest.approx(k, abs=0.05)
    if m is not None:
        assert quadrature_exponent(SHAPES[name]) == pytest.approx(m, abs=0.1)
