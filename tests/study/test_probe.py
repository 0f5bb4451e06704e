"""Probes: what is right, spoken of, refused, silent and failed."""

from __future__ import annotations

import warnings
from types import ModuleType

import numpy as np
import pytest

from fracparticles.errors import AccuracyWarning, FracparticlesError, InvalidInput
from fracstudy.probe import HELD, REFUSED, Kind, Verdict, frame, off, overheard, probes_of, quiet


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


def test_what_a_kind_says_holds_unless_a_probe_says_otherwise():
    kind = Kind("k", "e", 1.0, "closed form", HELD)
    assert kind("c", float, 0.5) == kind("c", lambda: 0.5)
    loose = kind("c", float, 1.5, bound=2.0, source="")
    assert (loose.bound, loose.source, loose.verdict) == (2.0, "", "held")
    assert kind("c", float, 1.5).verdict == "silent"


def test_what_must_be_refused_may_return_anything():
    refused, accepted = Kind("k", must=REFUSED).of({"no": refuses, "yes": lambda: np.ones(3)})
    assert (refused.verdict, refused.expected) == ("refused", "refused")
    assert (accepted.verdict, accepted.found) == ("failed", "accepted")


def test_off_is_relative_to_the_greatest_exact_value():
    assert off([1.0, -3.0], [1.0, -4.0]) == 0.25
    assert off([1.0, -3.0], [1.0, -4.0], 0.5) == 2.0
    assert np.isnan(off([np.nan], [1.0]))


def overflows_and_grows():
    overflows()
    grows(1.0)()


def grows_and_refuses():
    grows(1.0)()
    refuses()


def test_warnings_are_overheard_and_go_on():
    loud = pytest.warns(AccuracyWarning, match="it grows")
    with quiet(RuntimeWarning), loud, overheard() as words:
        overflows_and_grows()
    assert words == ["it grows"]


def test_warnings_are_overheard_of_what_ends_in_an_error():
    with quiet(), pytest.raises(FracparticlesError), overheard() as words:
        grows_and_refuses()
    assert words == ["it grows"]


def test_quiet_says_nothing_of_one_kind_of_warning():
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        with quiet(AccuracyWarning):
            grows(1.0)()
            warnings.warn("another", UserWarning, stacklevel=1)
    assert [str(one.message) for one in caught] == ["another"]


def test_one_function_is_probed_with_several_arguments():
    kind = Kind("k", "small", 1.0)
    made = list(kind.over(lambda x, y: x - y, {"a": (1.0, 0.5), "b": (3.0, 1.0)}, source="scipy"))
    assert [(one.case, one.deviation, one.source) for one in made] == [
        ("a", 0.5, "scipy"),
        ("b", 2.0, "scipy"),
    ]


def test_the_families_of_a_module_are_made_in_their_order_with_what_they_take():
    module = ModuleType("families")
    exec(
        "from itertools import product\n"
        "def second(b, kind): yield kind('second', float, b)\n"
        "def _hidden(a, kind): yield kind('hidden', float, a)\n"
        "def no_family(a): return a\n"
        "def first(a, b, kind): yield kind('first', float, a + b)\n",
        vars(module),
    )
    made = [(p.case, p.deviation) for p in probes_of(module, a=1.0, b=2.0, c=3.0, kind=Kind("k"))]
    assert made == [("second", 2.0), ("first", 3.0)]
