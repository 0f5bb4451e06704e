"""A D that changes in time, on bounded domains: `space_error` knows what the data leave, as it does of a D at rest.

Before the ends are felt a D of the time alone makes of the waves of the data e^(-s |k|^alpha), s = int D dt.
"""

from __future__ import annotations

from math import gamma

import numpy as np
import pytest
import spectral
from kinks import KINKS, SAID, solution, solved
from scipy.interpolate import RegularGridInterpolator

from fracparticles.problems import Problem, solve_problem
from fracparticles.problems.steady_diffusion import diffused
from sweeps import covering

COUNT = 64
FIELDS = {"half_width": 1.0, "exterior": "absorbing", "spacing": None}

# By the time over that of the run: D as a text, and s over that time.
CHANGES = {
    "rises": ("1 + 3*t/{T}", lambda part: part + 1.5 * part**2),
    "falls": ("exp(-3*t/{T})", lambda part: (1.0 - np.exp(-3.0 * part)) / 3.0),
}


@pytest.mark.parametrize(
    ("alpha", "change", "kind", "at", "as_array"),
    covering([1.2, 1.8], CHANGES, ["tent", "cusp", "box"], [0.0, 0.013], [False, True]),
)
def test_data_on_an_interval(alpha, change, kind, at, as_array):
    """Half of the particles alone said a fiftieth of a tent, a thirtieth of a box in silence."""
    (given, transform), width = KINKS[kind], {"tent": 0.15, "cusp": 0.15, "box": 0.4}[kind]
    text, s = CHANGES[change]
    last = 3.0 * (2.0 / COUNT) ** alpha
    fields = FIELDS | {"alpha": alpha, "particles": COUNT, "times": (0.1 * last, last)}
    fields["diffusivity"] = text.format(T=last)
    x = Problem(**fields).places["x"]

    def data(x):
        return given((x - at) / width)

    run, warned = solved(data(x) if as_array else data, **fields)
    for u, part, said in zip(run.u.values, (0.1, 1.0), run.space_error.values, strict=True):
        exact = solution(lambda k: width * transform(width * k), x - at, last * s(part), alpha)
        off = np.abs(u - exact)[np.abs(x) < 0.6].max() / np.abs(u).max()
        # Three times as many place a jump to a sixth of the spacing, beneath the peak of the fundamental solution.
        peak = gamma(1.0 + 1.0 / alpha) / np.pi * (last * s(part)) ** (-1.0 / alpha)
        placed = min(0.5, np.diff(x).max() / 6.0 * peak) if kind == "box" else 0.0
        assert off < 1.5 * said + placed
        assert warned or off < SAID


@pytest.mark.parametrize(("form", "kind"), [("FPSE", "box"), ("exchange", "tent")])
def test_layers_that_move(monkeypatch, form, kind):
    monkeypatch.setattr(spectral, "_LENGTH", 6.0)
    monkeypatch.setattr(spectral, "_POINTS", 2**11)
    alpha, (given, _), width = 1.5, KINKS[kind], {"tent": 0.15, "box": 0.4}[kind]
    last = 2.0 * (2.0 / COUNT) ** alpha

    def d(x, t):
        return 1.0 + 0.9 * np.sin(2.0 * np.pi * (x + t / last))

    def data(x):
        return given((x - 0.013) / width)

    fields = FIELDS | {"particles": COUNT, "times": (last / 4.0, last), "diffusivity": d}
    fields["rtol"] = 1e-4  # the particles leave a hundred times as much
    run, _ = solved(data, alpha=alpha, form=form, **fields)
    x = run.x.values
    for u, t, said in zip(run.u.values, fields["times"], run.space_error.values, strict=True):
        exact = spectral.circle(
            alpha, data, t, d, lambda x, t: 0.0 * x, lambda x, t, u: 0.0 * x, form == "exchange"
        )
        off = np.abs(u - exact(x))[np.abs(x) < 0.6].max() / np.abs(u).max()
        assert said / 4.0 < off < 1.5 * said


@pytest.mark.parametrize(("domain", "particles"), [("square", 24), ("disc", 16)])
def test_a_jump_in_the_plane(domain, particles):
    """The middle half, whose corners are those of a disc, on a square of Fourier series."""
    alpha, width, at = 1.5, 0.6, 0.03
    last = 3.0 * particles**-alpha
    fields = FIELDS | {"alpha": alpha, "domain": domain, "particles": particles, "t_final": last}
    fields["diffusivity"] = f"2*t/{last}"
    run = solve_problem(
        Problem(**(fields | {"diffusivity": f"0.1 + 2*t/{last}"})),
        lambda x, y: 1.0 * ((np.abs(x - at) < 0.5 * width) & (np.abs(y) < 0.5 * width)),
    )
    points, length = 1024, 6.0
    k = 2.0 * np.pi * np.fft.fftfreq(points, length / points)
    one = width * np.sinc(0.5 * width * k / np.pi) * points / length
    waves = np.outer(one * np.exp(-1j * k * at), one)
    waves *= np.exp(-1.1 * last * np.hypot(k[:, None], k) ** alpha)
    axis = (np.arange(points) - points // 2) * length / points
    exact = RegularGridInterpolator((axis, axis), np.fft.fftshift(np.fft.ifft2(waves).real))
    x, y = Problem(**(fields | {"diffusivity": 1.0})).places.values()
    x, y = np.broadcast_arrays(x, y)
    off = np.abs(run.u.values - exact((x, y)))[np.hypot(x, y) < 0.7].max() / float(run.u.max())
    assert off < 2.0 * float(run.space_error)
    assert off > float(run.space_error) / 8.0


def test_many_times_take_few_pieces():
    """D of a place and the time: eight output times are pieces that each last as long as all before."""
    asked = []

    def solve(problem, initial):
        asked.append((problem.t_initial, problem.output_times))
        return [np.zeros(16) for _ in problem.output_times]

    times = tuple(float(n) for n in range(1, 9))
    problem = Problem(
        alpha=1.5, half_width=1.0, exterior="absorbing", particles=16, times=times,
        diffusivity="1 + x*sin(t)/2",
    )  # fmt: skip
    assert len(diffused(problem, np.zeros(16), solve)) == 8
    assert [start for start, _ in asked] == [0.0, 1.0, 2.0, 4.0]
    assert sum((late for _, late in asked), ()) == times


def test_smooth_data_stay_silent():
    run, warned = solved(
        lambda x: np.exp(-((x / 0.3) ** 2)), alpha=1.5, particles=COUNT, t_final=0.05,
        diffusivity="1 + sin(40*t)", **FIELDS,
    )  # fmt: skip
    assert not warned
    assert float(run.space_error) < 0.01
