"""The points of a figure in long form, and its panels."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from fracstudy.panels import Panels, pick
from fracstudy.style import (
    axes_row,
    border,
    curves,
    guide,
    log_log,
    name_ticks,
    plain_times,
    small_legend,
)


def test_points_are_kept_in_order_with_what_else_is_said_of_them():
    panels = Panels()
    panels.add("a", "line", np.arange(3.0), np.arange(3.0) ** 2, t=1.0)
    panels.add("a", "point", 4.0, 2.0)
    part = pd.DataFrame({"S": ["S4", "S8"], "x": [1.0, 2.0]}, index=[7, 9])
    panels.add("b", part["S"], part["x"], part["x"])
    panels.add("b", "none", [], 0.0)
    frame = panels.frame
    assert list(frame["x"]) == [0.0, 1.0, 2.0, 4.0, 1.0, 2.0]
    assert list(pick(frame, panel="a", series="line")["y"]) == [0.0, 1.0, 4.0]
    assert list(pick(frame, panel="b", series="S8")["x"]) == [2.0]
    assert frame["t"].notna().sum() == 3


def test_points_may_be_given_by_name_and_have_the_columns_named_alone():
    panels = Panels()
    panels.add("a", beta=0.5, x=[1.0, 2.0], y=[3.0, 4.0])
    assert list(panels.frame) == ["panel", "beta", "x", "y"]
    assert list(panels.frame["beta"]) == [0.5, 0.5]


@pytest.mark.parametrize(
    ("panels", "titles"),
    [(1, [""]), (2, ["(a)", "(b)"]), (["one"], ["(a) one"]), (["one", ""], ["(a) one", "(b)"])],
)
def test_panels_of_a_figure_are_lettered_and_titled(panels, titles):
    _, axes = axes_row(panels)
    assert [ax.get_title(loc="left") for ax in axes] == titles


def test_panels_may_stand_in_rows_of_one_size():
    figure, axes = axes_row(4, height=2.0, width=3.0, rows=2)
    assert tuple(figure.get_size_inches()) == (6.0, 4.0)
    assert [ax.get_subplotspec().rowspan.start for ax in axes] == [0, 0, 1, 1]


def test_each_series_has_a_curve_with_a_look_and_a_name_of_its_own():
    panels = Panels()
    for name in ("late", "early"):
        panels.add("a", name, [1.0, 10.0], [2.0, 3.0])
    _, (ax,) = axes_row()
    curves(ax, panels.frame, name="{} one", linestyle="--")
    curves(ax, panels.frame, name=None, marker=".")
    assert [line.get_label() for line in ax.lines[:2]] == ["late one", "early one"]
    first, second, unnamed, _ = ax.lines
    assert first.get_linestyle() == second.get_linestyle() == "--"
    assert first.get_color() != second.get_color()
    assert first.get_marker() != second.get_marker()
    assert unnamed.get_color() == first.get_color()
    assert unnamed.get_label().startswith("_")  # not in a legend
    small_legend(ax, "upper left", ncols=2)
    assert [text.get_fontsize() for text in ax.get_legend().get_texts()] == [7.0, 7.0]


def test_times_are_plain_numbers():
    figure, (ax,) = axes_row()
    ax.plot([0.03, 300.0], [1.0, 1.0])
    log_log(ax)
    plain_times(ax)
    figure.canvas.draw()
    labels = [label.get_text() for label in ax.get_xticklabels()]
    assert [label for label in labels if 0.03 <= float(label) <= 300.0] == ["0.1", "1", "10", "100"]


def test_a_short_axis_of_times_has_twos_and_fives():
    figure, (ax,) = axes_row()
    ax.plot([400.0, 3000.0], [1.0, 1.0])
    log_log(ax)
    plain_times(ax)
    figure.canvas.draw()
    labels = [label.get_text() for label in ax.get_xticklabels()]
    assert [label for label in labels if 400.0 <= float(label) <= 3000.0] == ["500", "1000", "2000"]


@pytest.mark.parametrize(("slope", "end", "side"), [(1.0, 100.0, "right"), (-1.0, 1.0, "left")])
def test_the_name_of_a_guide_stands_at_its_upper_end(slope, end, side):
    _, (ax,) = axes_row()
    log_log(ax)
    guide(ax, (1.0, 100.0), (10.0, 1.0), slope, "a law")
    (text,) = ax.texts
    assert text.xy == (end, pytest.approx(10.0))
    assert text.get_ha() == side


def test_a_border_has_a_name_if_it_is_given_one():
    _, (ax,) = axes_row()
    border(ax, 1.0)
    assert not ax.texts
    border(ax, 2.0, "no more")
    assert [text.get_text() for text in ax.texts] == ["no more"]
    assert [line.get_linestyle() for line in ax.lines] == [":", ":"]


def test_ticks_inside_a_panel_do_not_widen_it():
    _, (ax,) = axes_row()
    ax.set_xlim(0.0, 1.0)
    name_ticks(ax, (-1.0, 0.5, 2.0), inside=True)
    assert [text.get_text() for text in ax.get_xticklabels()] == ["0.5"]
    assert ax.get_xlim() == (0.0, 1.0)
    name_ticks(ax, (0.5, 2.0))
    assert ax.get_xlim()[1] >= 2.0
