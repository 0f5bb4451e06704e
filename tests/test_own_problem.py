"""The page "From your problem to a run": each of its blocks is executed, and does what it says."""

from __future__ import annotations

from pathlib import Path

import matplotlib as mpl
import numpy as np
import pytest
from scipy.interpolate import CubicSpline

import fracparticles as fp
from pages import blocks, executed

mpl.use("Agg")
ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs" / "own_problem.md"
BLOCKS = blocks(PAGE)


@pytest.fixture(scope="module")
def done(tmp_path_factory):
    """Run the page in a folder of its own and return its names, and the folder."""
    with executed(PAGE, tmp_path_factory.mktemp("page")) as names:
        yield names, Path.cwd()


def test_the_readme_links_the_page():
    assert "docs/own_problem.md" in (ROOT / "README.md").read_text("utf-8")


def test_there_are_blocks_of_each_kind():
    assert {kind for kind, _ in BLOCKS} == {"python", "text", ""}


def test_the_blob_is_as_accurate_as_asked_and_says_so(done):
    names, folder = done
    run, blob = names["run"], names["blob"]
    assert run.t.values.tolist() == [1.0, 10.0, 30.0]
    assert (run.x.attrs["units"], run.t.attrs["units"], run.u.attrs["units"]) == ("m", "d", "mg/L")
    assert (folder / "blob.png").stat().st_size > 1000
    n, h = 16384, 0.125
    x = (np.arange(n) - n // 2) * h
    for k, t in enumerate(run.t.values):
        wide = fp.evolve(blob(x), h, 1.6, float(t), diffusivity=2.0, tail=())
        exact = CubicSpline(x, wide)(run.x.values)
        error = np.abs(run.u.values[k] - exact).sum() / np.abs(exact).sum()
        assert error <= 3.0 * float(run.estimated_error[k])
        assert float(run.estimated_error[k]) < 1e-2  # on the whole lattice, ends included


def test_the_mass_is_accounted_for(done):
    names, _ = done
    assert names["mass"][-1] < names["mass"][0]
    assert names["mass"] + names["beyond"] == pytest.approx(1.0, abs=0.01)


def test_the_profile_states_its_error(done):
    names, folder = done
    salt = names["salt"]
    assert salt.u.dims == ("t", "x")
    assert salt.x.attrs["units"] == "m"
    assert 0.0 < float(salt.interpolation_error) < 0.05
    assert names["later"].u.attrs["units"] == "g/L"
    assert (folder / "salt.nc").is_file()
    # Of the command line, which estimates the error.
    assert fp.read_run(folder / "salt.nc").estimated_error.dims == ("t",)


def test_the_puff_is_where_it_was_put(done):
    names, folder = done
    peak = names["plane"].u.where(names["plane"].u == names["plane"].u.max(), drop=True)
    assert float(peak.x[0]) == pytest.approx(2.0, abs=0.5)
    assert float(peak.y[0]) == pytest.approx(-1.0, abs=0.5)
    assert (folder / "puff.png").stat().st_size > 1000


def test_drift_and_decay_solve_their_equation(done):
    """Against the symbol exp(-t (D |k|^alpha + i k v + k0)) on a wide lattice."""
    names, _ = done
    n, h = 16384, 0.125
    x = (np.arange(n) - n // 2) * h
    k = 2.0 * np.pi * np.fft.fftfreq(n, h)
    symbol = np.exp(-10.0 * (2.0 * np.abs(k) ** 1.6 + 1j * k * 0.8 + 0.05))
    exact = np.fft.ifft(np.fft.fft(names["blob"](x)) * symbol).real
    decayed = names["decayed"]
    assert decayed.values == pytest.approx(
        np.interp(decayed.x.values, x, exact), abs=2e-3 * exact.max()
    )


def test_a_million_days(done):
    names, _ = done
    mass = 100.0 * 3.0 * np.sqrt(np.pi)
    exact = mass * fp.green(names["place"], 2.0e6, 1.6)
    assert np.abs(names["far"] - exact).max() <= 1e-6 * exact.max()
