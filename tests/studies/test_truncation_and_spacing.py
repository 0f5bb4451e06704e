"""The studies of the truncation and the spacing: closed forms, synthetic data, and runs on tiny grids."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from fracparticles.run.case import Case
from fracparticles.run.dataset import write
from fracparticles.run.solution import relative_l1_error
from fracparticles.run.solver import compute, solve
from fracstudy.inputs import Inputs, observed_order
from fracstudy.scene import expand
from scene_functions import figure, study
from scenes.lucchesi.lucchesi_table_2.study import self_convergence_order
from scenes.lucchesi.spacing_shared import spacing
from scenes.lucchesi.truncation_shared import exchange_truncation_error, truncation


def computed(tmp_path, blocks):
    paths = []
    for case in expand(blocks):
        path = tmp_path / case.path
        write(solve(case), path)
        paths.append(str(path))
    return paths


@pytest.mark.parametrize(("beta", "spacing"), [(0.1, 0.1), (0.5, 0.05), (0.9, 0.04)])
def test_the_closed_form_is_the_truncation_error_of_an_exchange_scheme(beta, spacing):
    # Beside it: the next term in 1/D, of relative size D^-alpha <= 3 %, and a spatial error below 1 % of it.
    case = Case(
        scheme="KPSE",
        order=4,
        beta=beta,
        truncation=40.0,
        spacing=spacing,
        integrator="exponential",
    )
    solution = compute(case)
    error = relative_l1_error(case, solution.u)
    assert error == pytest.approx(exchange_truncation_error(case.domain, 1 + beta, 1.0), rel=0.05)


@pytest.mark.parametrize("order", [1.0, 2.0, 4.0])
def test_self_convergence_of_an_exact_power_is_its_order(order):
    x = np.linspace(-1.0, 1.0, 41)
    levels = [np.cos(x) + np.sin(3.0 * x) * 0.5 ** (order * level) for level in range(3)]
    # Subtracting neighbouring levels loses log10(2^order) digits of 16.
    assert self_convergence_order(levels) == pytest.approx(order, abs=1e-12)
    h = 0.5 ** np.arange(5)
    np.testing.assert_allclose(observed_order(h, 3.0 * h**order), order, rtol=1e-12)


@pytest.fixture(scope="module")
def truncated(tmp_path_factory):
    common = {"beta": 0.5, "spacing": 0.08, "exterior": ["truncated", "open"], "store": "metrics"}
    blocks = [
        {
            "scheme": ["DD", "FPSE", "KPSE"],
            "order": [2, 4],
            "truncation": [10.0, 20.0, 40.0],
            "dt": 2e-3,
        },
        {"scheme": "GPSE", "truncation": [10.0, 20.0, 40.0], "dt": 0.0625},
    ]
    runs = computed(tmp_path_factory.mktemp("runs"), [{**common, **block} for block in blocks])
    return truncation(Inputs("lucchesi_figure_4a", ["L-F4a"], {"beta": 0.5}, runs))


def test_truncation_tabulates_every_scheme_order_and_width(truncated):
    table = truncated.table
    assert len(table) == 7 * 3
    kpse = table[(table["scheme"] == "KPSE") & (table["order"] == "IV")]
    # The closed form is 5 % exact from C = 10 on, and the spatial error a hundredth of it at this h.
    np.testing.assert_allclose(
        kpse["error, truncated"], kpse["truncation error, predicted"], rtol=0.3
    )
    assert (kpse["error, open exterior"] < kpse["error, truncated"]).all()


def test_truncation_refutes_what_the_data_refute(truncated):
    verdicts = {finding.claim: finding.verdict for finding in truncated.findings}
    assert verdicts["L-F4a.negligible"] is False
    steps = [finding.ours for finding in truncated.findings if finding.claim == "L-F4a.gpse_dt"]
    assert steps == [pytest.approx((2 * 0.08) ** 1.5)]


def test_the_claims_on_truncation_read_the_tables(truncated):
    tables = {f"t{beta:g}": truncated.table.assign(beta=beta) for beta in (0.1, 0.5, 0.9)}
    items = ["L-C4", "L-C5", "L-C6"]
    result = study("truncation_claims")(Inputs("truncation_claims", items, {}, (), tables))
    assert len({finding.claim for finding in result.findings}) == 15
    assert all(finding.evidence for finding in result.findings)
    verdicts = {finding.claim: finding.verdict for finding in result.findings}
    assert verdicts["L-C5.origin"] is True
    assert verdicts["L-C6.different_mechanism"] is False
    drawn = figure("truncation_claims")(result.series, result.table, {})
    assert len(drawn.axes) == 3


def test_spacing_finds_the_orders_of_the_kernels(tmp_path):
    half = Case(scheme="DD", beta=0.5, truncation=20.0, spacing=0.1, dt=1e-3).domain
    h = [half / n for n in (128, 256, 512)]
    block = {
        "scheme": ["DD", "FPSE", "KPSE"],
        "order": [2, 4],
        "beta": 0.5,
        "truncation": 20.0,
        "spacing": h,
        "store": "metrics",
    }
    runs = computed(
        tmp_path,
        [
            {**block, "dt": 1e-3, "exterior": ["truncated", "open"]},
            {**block, "scheme": "KPSE", "integrator": "exponential"},
        ],
    )
    result = spacing(Inputs("lucchesi_figure_4b", ["L-F4b"], {"beta": 0.5}, runs))
    table = result.table
    assert len(table) == 3 * 2 * 3
    finest = table.groupby(["scheme", "order"])["observed order, open"].last().unstack()
    # The next term of the error is of relative size (k epsilon)^2: 6 % at k ~ 1 and epsilon = 2 h = 0.17.
    np.testing.assert_allclose(finest["II"], 2.0, atol=0.1)
    np.testing.assert_allclose(finest["IV"], 4.0, atol=0.2)
    parts = {f"t{beta:g}": table.assign(beta=beta) for beta in (0.1, 0.5, 0.9)}
    claims = study("spatial_claims")(Inputs("spatial_claims", ["L-C7", "L-C8"], {}, (), parts))
    verdicts = {finding.claim: finding.verdict for finding in claims.findings}
    assert verdicts["L-C8.cause"] is False
    for name, drawn in (("spacing", result), ("truncation", None)):
        if drawn is not None:
            assert figure(name)(drawn.series, drawn.table, {"beta": 0.5}).axes


def test_the_reference_case_judges_both_windows(tmp_path):
    common = {"beta": 0.5, "truncation": 20.0, "spacing": 0.03, "store": "field"}
    moving = {"scheme": "DVM", "dt": 5e-3, "remeshing": ["M4'", "none"]}
    runs = computed(
        tmp_path,
        [
            {
                **common,
                "scheme": ["DD", "FPSE", "KPSE"],
                "dt": 1e-3,
                "exterior": ["truncated", "open"],
            },
            {**common, "scheme": "GPSE", "dt": 0.05, "exterior": ["truncated", "open"]},
            {**common, "scheme": "FD", "dt": 1e-3},
            {**common, **moving, "truncation": 10.0, "spacing": 0.03},
            {**common, **moving, "truncation": [5.0, 10.0, 20.0], "spacing": 0.1995350},
            {
                **common,
                "scheme": ["DD", "KPSE"],
                "truncation": [5.0, 10.0, 20.0],
                "spacing": 0.1995350,
                "dt": 1e-2,
            },
        ],
    )
    parameters = {
        "spacing": 0.03,
        "windows": [[0.0, 5.0], [40.0, 45.0]],
        "printed_particles": 64000,
        "mass_beta": [0.5],
    }
    result = study("lucchesi_figure_2")(Inputs("f2", ["L-F2", "L-C1", "L-C2"], parameters, runs))
    verdicts = {finding.claim: finding.verdict for finding in result.findings}
    assert verdicts["L-F2.peak"] is True, result.findings[0].evidence
    assert verdicts["L-F2.initial_decay"] is False
    assert verdicts["L-C1.odd_number"] is False
    assert verdicts["L-F2.DVM_window"] is False
    assert verdicts["L-C1.DVM_domain"] is False
    assert set(result.series["panel"]) == {0, 1}
    assert isinstance(result.table, pd.DataFrame)
    assert len(figure("lucchesi_figure_2")(result.series, result.table, parameters).axes) == 3
