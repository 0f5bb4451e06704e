"""alpha or beta, never both: in a case, in a run block, on the command line."""

from __future__ import annotations

import numpy as np
import pytest

import fracparticles as fp
from fracparticles.command_line.cli import main
from fracparticles.errors import InvalidInput
from fracstudy.run_blocks import RunBlock, expand
from sweeps import at_once

GIVEN = {"scheme": "KPSE", "half_width": 20.0, "spacing": 0.2, "integrator": "exponential"}


@at_once(range(1, 100))
def test_they_are_the_same_case(hundredths):
    beta = hundredths / 100
    by_beta = fp.Case(**GIVEN, beta=beta)
    by_alpha = fp.Case(**GIVEN, alpha=float(f"1.{hundredths:02d}"))
    assert by_alpha == by_beta
    assert by_alpha.path == by_beta.path
    assert fp.Case.from_json(by_alpha.to_json()) == by_beta


def test_any_number_of_numpy():
    assert fp.Case(**GIVEN, alpha=np.float64(1.5)).beta == 0.5
    assert fp.Case(**GIVEN, alpha=1.5, beta=None).beta == 0.5


@pytest.mark.parametrize(
    ("given", "field", "words"),
    [
        ({"alpha": 1.5, "beta": 0.5}, "alpha", "alpha = 1 [+] beta"),
        ({"alpha": 0.5}, "alpha", "1 < alpha < 2"),
        ({"alpha": 2.0}, "alpha", "1 < alpha < 2"),
        ({"alpha": "1.5"}, "alpha", "1 < alpha < 2"),
        ({"alpha": True}, "alpha", "1 < alpha < 2"),
        ({"alpha": float("nan")}, "alpha", "1 < alpha < 2"),
        ({"beta": 1.5}, "beta", "Give beta = alpha - 1, or alpha itself"),
        ({}, "beta", "Give beta = alpha - 1, or alpha itself"),
    ],
)
def test_what_is_refused_says_what_alpha_is(given, field, words):
    with pytest.raises(InvalidInput, match=words) as refused:
        fp.Case(**GIVEN, **given)
    assert refused.value.field == field


def test_in_a_run_block_and_on_the_command_line(tmp_path, capsys):
    block = {**GIVEN, "alpha": [1.3, 1.5]}
    assert [case.beta for case in expand([RunBlock(**block)])] == [0.3, 0.5]
    flags = [f"--{name.replace('_', '-')}={value}" for name, value in GIVEN.items()]
    assert main(["solve", *flags, "--alpha", "1.3", "-o", str(tmp_path / "run.nc")]) == 0
    assert float(fp.read_run(tmp_path / "run.nc").beta) == 0.3
    capsys.readouterr()
    assert main(["limit", "--scheme", "KPSE", "--alpha", "1.5"]) == 0
    by_alpha = capsys.readouterr().out
    assert main(["limit", "--scheme", "KPSE", "--beta", "0.5"]) == 0
    assert capsys.readouterr().out == by_alpha
    assert main(["limit", "--scheme", "KPSE"]) == 2
    assert "--alpha" in capsys.readouterr().err
