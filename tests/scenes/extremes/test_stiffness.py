"""Stiff problems: every way is right, or says what it cannot."""

from __future__ import annotations

import pytest

from fracstudy.panels import pick

PARAMETERS = {"schemes": ["KPSE", "DD"], "half": 8, "stiffness": [1e2, 1e4], "most": 2e3}


def test_every_probe_holds_or_is_spoken_of(bad):
    assert bad == ""


def test_round_off_warns_and_what_takes_too_long_is_refused(table):
    verdicts = table.groupby("kind")["verdict"].agg(set)
    assert verdicts["a word"] == {"warned"}
    assert verdicts["refused"] == {"refused"}


def test_the_work_of_the_exponential_grows_like_the_root_of_the_stiffness(result):
    work = pick(result.series, panel="applications", series="exponential").set_index("x")["y"]
    # degree ~ sqrt(2 log(1 / eps) T |low|) once T |low| >> log(1 / eps) = 37; at 100 it is a little more
    assert work[1e4] / work[1e2] == pytest.approx(10.0, rel=0.15)


def test_the_figure_is_drawn(drawn):
    assert len(drawn.axes) == 2
