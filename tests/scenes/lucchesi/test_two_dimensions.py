"""The scenes of Sec. 5: what they compute beside the runs, and every study and figure on tiny lattices."""

from __future__ import annotations

from math import pi

import numpy as np
import pandas as pd
import pytest

from fracparticles.kernels.families import kernel
from fracparticles.run.case import Case
from fracparticles.schemes import SCHEMES
from fracparticles.special import green, green_flux
from fracstudy.inputs import Inputs
from scenes.lucchesi.lucchesi_2d_mass.study import study as masses
from scenes.lucchesi.lucchesi_2d_orders.study import study as orders
from scenes.lucchesi.lucchesi_2d_tables.figure import figure as draw_tables
from scenes.lucchesi.lucchesi_2d_tables.study import spurious_rate
from scenes.lucchesi.lucchesi_2d_tables.study import study as tables
from scenes.lucchesi.lucchesi_figure_6.figure import figure as draw_density
from scenes.lucchesi.lucchesi_figure_6.study import study as density
from scenes.lucchesi.lucchesi_figure_7.figure import figure as draw_operators
from scenes.lucchesi.lucchesi_figure_7.study import flux_along_axis
from scenes.lucchesi.lucchesi_figure_7.study import study as operators
from scenes.lucchesi.lucchesi_figure_8.figure import figure as draw_profiles
from scenes.lucchesi.lucchesi_figure_8.study import study as profiles
from scenes.lucchesi.lucchesi_figure_9.figure import figure as draw_errors
from scenes.lucchesi.lucchesi_figure_9.study import study as errors

ALPHA = 1.5
# The half-width is 8.94; N = 17, 33, 65.
SPACINGS = [1.117395, 0.5586979, 0.279349]
COMMON = {"beta": 0.5, "dim": 2, "truncation": 4.0, "dt": 5e-3}


def findings(result):
    return {finding.claim: finding for finding in result.findings}


def test_the_flux_along_the_axis_is_exact_but_for_the_smoothing():
    deviations = []
    for spacing in (0.1, 0.05):
        grid = {"beta": 0.5, "dim": 2, "half_width": 8.0, "spacing": spacing}
        case = Case(scheme="FPSE", integrator="exponential", **grid)
        u = np.asarray(green(case.radius, 1.5, ALPHA, 2))
        flux = flux_along_axis(case, u)
        np.testing.assert_allclose(flux, -flux[::-1], atol=1e-14)
        inside = np.abs(case.x) < 3.0
        exact = np.asarray(green_flux(case.x, 1.5, ALPHA, 2))
        deviations.append(np.abs(flux - exact)[inside].max() / exact.max())
    assert deviations[0] / deviations[1] == pytest.approx(4.0, rel=0.1)
    assert deviations[1] < 0.01


@pytest.mark.parametrize("step", [0.1, 0.01])
def test_a_table_damps_a_uniform_field_at_the_spurious_rate(step):
    case = {"scheme": "DD", "beta": 0.5, "dim": 2, "half_width": 8.0, "spacing": 0.2}
    exact, tabled = (
        Case(**case, integrator="exponential", kernel_table=table) for table in (None, step)
    )
    change = [
        SCHEMES["DD"].operator(c.setting).apply(np.ones(c.particles)).reshape(c.shape)[c.n, c.n]
        for c in (exact, tabled)
    ]
    rate = spurious_rate(exact, step)
    # The sums run over the square around the particle in the middle: the same in both.
    assert change[1] - change[0] == pytest.approx(-rate, rel=1e-9)
    # Euler and Maclaurin, which knows nothing of where the lattice meets the table: the size only.
    epsilon = 2.0 * exact.particle_spacing
    continuous = -pi * step**2 / 6.0 * kernel("G", 0.0, ALPHA, dim=2) / epsilon**ALPHA
    assert 0.3 < rate / continuous < 3.0


def test_density():
    limits = {"series_up_to": 5.0, "asymptotic_from": 3.0, "integral_up_to": 40.0}
    terms = {"series": 120, "asymptotic": 12, **limits}
    reach = [0.02, 300.0]
    inputs = Inputs("a", ["L-F6"])
    result = density(inputs, beta=0.5, radii=[0.0, 1.0, 5.0, 50.0], reach=reach, terms=terms)
    numbers = findings(result)["L-F6.fundamental"].numbers
    assert max(numbers["mass"], numbers["integral"]) < 1e-12
    assert numbers["equation"] < 1e-7
    # At the origin d/dt of t^(-2 / alpha) Phi(0) is -2 Phi(0) / alpha.
    assert numbers["rate"] == pytest.approx(-2.0 * green(0.0, 1.0, ALPHA, 2) / ALPHA, rel=1e-9)
    draw_density(result.series, beta=0.5, reach=reach).draw_without_rendering()


def test_operators():
    printed = [17, 33, 65]
    grid = {"beta": 0.5, "truncation": 4.0, "particles": printed, "finer": [129]}
    result = operators(Inputs("b", ["L-F7"]), time=0.5, **grid)
    assert len(result.table) == 3 * 4
    found = findings(result)
    assert max(found["L-F7.flux_converges"].numbers["ratio"].values()) < 1.0
    # On lattices as coarse as these the order is not 2: it can fail.
    second = found["L-F7.second_order"].numbers
    assert max(second["difference"].values()) > 0.25
    assert second["order"]["DD"] == pytest.approx(2.0 - second["difference"]["DD"])
    figure = draw_operators(result.series, result.table, time=0.5, particles=printed, reach=3.0)
    figure.draw_without_rendering()


def test_profiles(computed):
    block = {"scheme": ["DD", "FPSE"], "spacing": 0.15, "exterior": ["truncated", "open"]}
    found = []
    for store in ("profile", "field"):
        files = computed([{**COMMON, **block, "dt": 2e-3, "store": store}])
        result = profiles(Inputs("c", ["L-F8", "L-C19"], runs=files))
        found.append(result.table)
    # A run that another scene shares may hold the whole field: the same comes out.
    pd.testing.assert_frame_equal(*found)
    assert len(result.table) == 8
    numbers = {claim: finding.numbers for claim, finding in findings(result).items()}
    assert max(numbers["L-C19.dd_below"]["median"].values()) < 0.0
    assert min(numbers["L-C19.fpse_above"]["median"].values()) > 0.0
    assert min(numbers["L-C19.truncation"]["gain"].values()) > 10.0
    # By the value the deviations are not slight, in decades of the plot they are.
    assert max(numbers["L-C19.slightly"]["deviation"].values()) > 0.25
    (plotted,) = findings(result)["L-C19.slightly"].others.values()
    assert max(plotted["deviation"].values()) < 0.25
    draw_profiles(result.series).draw_without_rendering()


def test_errors(computed):
    wide = {"truncation": [6.0], "spacing": SPACINGS[1]}
    both = {"spacing": SPACINGS[1], "exterior": ["truncated", "open"]}
    no_step = {name: value for name, value in COMMON.items() if name != "dt"}
    blocks = [
        {**COMMON, "scheme": ["DD", "FPSE"], "spacing": SPACINGS},
        {**COMMON, "scheme": ["DD", "FPSE", "KPSE"], **wide},
        {**no_step, "scheme": "GPSE", **wide},
        {**COMMON, "scheme": ["DD", "FPSE", "KPSE"], **both, "dim": [1, 2]},
        {**no_step, "scheme": "GPSE", **both, "dim": [1, 2]},
        {**COMMON, "scheme": "KPSE", "order": 4, **both},
    ]
    inputs = Inputs("e", ["L-F9"], runs=computed(blocks))
    result = errors(inputs, particles=[17, 33, 65])
    found = findings(result)
    assert max(found["L-F9.decreases"].numbers["ratio"].values()) < 1.0
    assert min(found["L-F9.fpse_larger"].numbers["ratio"].values()) > 1.0
    # r^(-n-alpha) and r^(-n-beta).
    np.testing.assert_allclose([*found["L-F9.decay"].numbers["change"].values()], -1.0, atol=1e-6)
    assert set(found["L-F9.weaker"].numbers["ratio"]) == {"DD", "FPSE"}
    table = result.table.set_index(["scheme", "order", "C", "N"])
    dd = table.loc[("DD", "II", 4.0)]
    assert dd["error of the field (7), truncated"].notna().all()
    assert dd["error (59), open exterior"].notna().sum() == 1
    # The observed order is that between a lattice and the one before.
    pair = dd["error (59), truncated"]
    assert dd["observed order, truncated"].loc[65] == pytest.approx(np.log2(pair[33] / pair[65]))
    draw_errors(result.series, particles=[17, 33, 65]).draw_without_rendering()
    # On other lattices than the printed ones there is nothing to judge, and no failure.
    other = errors(inputs, particles=[41, 81])
    assert not other.findings
    draw_errors(other.series, particles=[41, 81]).draw_without_rendering()


PRINTED = {
    "L-2D-ORD.DD.h0.223": "1.59",
    "L-2D-ORD.FPSE.h0.223": "1.52",
    "L-2D-MASS.dd_loss": "1.2",
}


def test_orders(computed):
    files = computed([{**COMMON, "scheme": ["DD", "FPSE"], "spacing": SPACINGS}])
    inputs = Inputs("f", ["L-2D-ORD"], runs=files, printed=PRINTED)
    result = orders(inputs, particles={"0.223": 33, "0.11": 1001})
    assert len(result.table) == 2 * 4  # there is no lattice of 1001
    # Three lattices: only h as the middle level can be had, and no tables.
    assert result.table[["ours, h as middle level", "deviation"]].notna().all(axis=None)
    assert result.table[["h as coarse level", "with kernel tables"]].isna().all(axis=None)
    half = Case(scheme="DD", spacing=1.0, **COMMON).reach
    assert findings(result)["L-2D-ORD.spacing.h0.223"].numbers["ours"] == pytest.approx(
        2.0 * half / 32.0
    )


def test_mass(computed):
    blocks = [
        {**COMMON, "scheme": ["DD", "FPSE"], "spacing": SPACINGS},
        {**COMMON, "scheme": "DD", "spacing": SPACINGS[1], "dim": 1},
    ]
    result = masses(Inputs("g", ["L-2D-MASS"], runs=computed(blocks), printed=PRINTED))
    table = result.table
    lost = "lost in the run, % of the initial mass"
    # FPSE conserves to round-off; DD loses about what the exact solution sends out.
    assert (table.loc[table["scheme"] == "FPSE", lost].abs() < 1e-9).all()
    assert (table.loc[table["scheme"] == "DD", lost] > 1.0).all()
    found = {claim: finding.numbers for claim, finding in findings(result).items()}
    assert found["L-2D-MASS.dd_loss"]["ours"] > 2.0
    assert min(found["L-2D-MASS.weaker"]["ratio"].values()) > 1.0


def test_tables(computed):
    block = {**COMMON, "scheme": ["DD", "FPSE"], "spacing": SPACINGS, "store": "metrics"}
    files = computed([block, {**block, "kernel_table": [0.01, 0.1]}])
    result = tables(Inputs("h", ["L-2D-TAB"], runs=files))
    found = findings(result)
    assert max(found["L-2D-TAB.F.step0.01"].numbers["change"].values()) < 0.05
    # On coarse lattices the table of step 0.1 does not show yet: it can fail.
    assert found["L-2D-TAB.G.step0.1"].numbers["drop"] < 0.5
    dd = result.table[result.table["scheme"] == "DD"]
    # ~ epsilon^-alpha.
    spurious = np.log2(dd["spurious decay in the run, step 0.1"])
    np.testing.assert_allclose(np.diff(spurious), ALPHA, atol=0.1)
    draw_tables(result.series).draw_without_rendering()
