"""Probes: what is right, spoken of, refused, silent and failed."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

from fracparticles.errors import AccuracyWarning, FracparticlesError, InvalidInput
from fracstudy.probe import Kind, Verdict, frame


def refuses():
    raise InvalidInput("x", -1, "at least 0", "Take more.")


def refuses_at_length():
    raise FracparticlesError("one line\nand another")


def divides():
    return 1 / 0


def grows(deviation):
    def run():
        warnings.warn("it grows", AccuracyWarning, stacklevel=1)
        return deviation

    return run


def overflows():
    return float(np.exp(np.float64(1e4)) * 0.0 + 0.0)


@pytest.mark.parametrize(
    ("run", "must", "verdict"),
    [
        (lambda: 0.5, None, "held"),
        (lambda: 1.0, None, "held"),
        (lambda: 1.5, None, "silent"),
        (lambda: np.nan, None, "silent"),
        (lambda: 1.5, Verdict.HELD, "silent"),
        (grows(1.5), None, "warned"),
        (grows(0.5), None, "held"),
        (grows(0.5), Verdict.WARNED, "warned"),
        (grows(1.5), Verdict.WARNED, "failed"),
        (lambda: 0.5, Verdict.WARNED, "failed"),
        (grows(1.5), Verdict.HELD, "failed"),
        (refuses, None, "refused"),
        (refuses, Verdict.REFUSED, "refused"),
        (refuses, Verdict.HELD, "failed"),
        (lambda: 0.5, Verdict.REFUSED, "failed"),
        (refuses_at_length, None, "failed"),
        (divides, None, "failed"),
        (overflows, None, "failed"),
    ],
)
def test_a_probe_is_judged(run, must, verdict):
    assert Kind("kind", "zero", 1.0, must=must)("case", run).verdict == verdict


def test_a_probe_says_what_was_found():
    kind = Kind("k", "e", 1.0)
    assert kind("c", lambda: 0.25).found == "2.5e-01"
    assert kind("c", lambda: (0.25, "a quarter")).found == "a quarter"
    assert kind("c", refuses).found.startswith("x = -1 is not allowed")
    assert kind("c", grows(2.0)).found == "it grows"
    assert kind("c", divides).found.startswith("ZeroDivisionError")


def test_probes_make_a_table():
    table = frame([Kind("k", "e", 1.0)("c", float, 0.25, source="closed form")])
    assert list(table.iloc[0]) == ["k", "c", "e", "closed form", "2.5e-01", 0.25, 1.0, "held"]
