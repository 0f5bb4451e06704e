"""What blows up says so itself: no warning of numpy comes before the error of ours."""

from __future__ import annotations

import warnings

import pytest

import fracparticles as fp
from fracparticles.errors import NonFiniteSolution
from fracparticles.run.solver import compute

WAYS = {
    "stepping": {"dt": 10.0, "evaluation": "stepping"},
    "series": {"dt": 10.0, "evaluation": "series"},
    "euler": {"dt": 10.0, "integrator": "euler"},
    "rk4": {"dt": 10.0, "integrator": "rk4"},
    "rk4, a huge step": {"dt": 1e60, "t_final": 1e61, "integrator": "rk4", "evaluation": "stepping"},
    "a huge diffusivity": {"dt": 0.01, "diffusivity": 1e90, "evaluation": "stepping"},
}  # fmt: skip


def blow_up(**fields) -> None:
    case = fp.Case(**{"beta": 0.5, "half_width": 8.0, "spacing": 0.4, "t_final": 1e4, **fields})
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # ours: that it will
        warnings.simplefilter("error", RuntimeWarning)
        with pytest.raises(NonFiniteSolution):
            compute(case)


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("scheme", ["PSE29", "RIESZ", "DD", "FD", "DPSE", "FPSE", "KPSE"])
def test_every_scheme_blows_up_by_our_error_alone(scheme, way):
    blow_up(scheme=scheme, **WAYS[way])


@pytest.mark.parametrize("order", [2, 4])
@pytest.mark.parametrize("t_final", [2000.0, 1e4, 1e5])
def test_what_grows_by_itself_overflows_by_our_error_alone(order, t_final):
    """Scheme (29) has positive eigenvalues, about 0.4 here, however small the step."""
    blow_up(scheme="PSE29", order=order, integrator="exponential", t_final=t_final)
