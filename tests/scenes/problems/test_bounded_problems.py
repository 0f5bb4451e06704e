"""Problems on bounded domains: what the scene says of its numbers."""

from __future__ import annotations

from fracstudy.panels import pick

PARAMETERS = {
    "counts": {"interval": [50, 100], "disc": [16, 32], "square": [12, 24]},
    "rtol": {"interval": 1e-7, "disc": 1e-5, "square": 1e-5},
}


def test_the_interval_has_five_digits_with_a_hundred_particles(result):
    rows = pick(result.table, domain="interval", particles=100).dropna(subset="observed order")
    assert len(rows) == 3
    assert (rows["error"] < 1e-5).all()
    assert (
        rows["observed order"] > rows["of theory"] - 0.8
    ).all()  # that of D(x, t) is still rising


def test_the_disc_has_the_order_of_its_rings(result):
    rows = pick(result.table, domain="disc", particles=32).dropna(subset="observed order")
    assert len(rows) == 2
    assert (rows["observed order"] > rows["of theory"] - 0.2).all()


def test_the_square_gains_with_its_particles(result):
    rows = pick(result.table, domain="square", particles=24).dropna(subset="observed order")
    assert (rows["observed order"] > 1.8).all()
    assert (rows["error"] < 5e-4).all()


def test_what_reflects_keeps_its_total_and_what_turns_only_turns(result):
    kept = pick(result.table, exterior="reflecting")
    assert len(kept) == 3
    assert (kept["drift of the total"] <= 1e-12).all()
    assert (pick(result.table, problem="rotation")["error"] < 1e-6).all()


def test_the_figure_has_its_panels(panels):
    assert len(panels) == 3
