"""The page "Coefficients, transport, sources, boundaries": its blocks are executed, and do what it says."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import fracparticles as fp
from fracparticles.bounded.interval_jacobi import jacobi_eigenvalues
from pages import executed

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs" / "other_equations.md"


@pytest.fixture(scope="module")
def done(tmp_path_factory):
    with executed(PAGE, tmp_path_factory.mktemp("page")) as names:
        yield names


def test_the_readme_links_the_page():
    assert "docs/other_equations.md" in (ROOT / "README.md").read_text("utf-8")


def test_the_problem_can_be_run_again_from_its_file(done):
    run, again = done["run"], fp.Problem.from_json(done["run"].attrs["problem"])
    assert again == done["problem"]
    assert run.t.values.tolist() == [0.5, 2.0]


def test_the_decay_takes_its_share_of_the_mass(done):
    """Transport and diffusion conserve; what a tail holds beyond the lattice is some L^-alpha."""
    run = done["run"]
    expected = np.sqrt(np.pi) * np.exp(-0.1 * run.t.values)
    assert run.mass.values == pytest.approx(expected, rel=40.0**-1.5)


def test_the_interval(done):
    assert done["interval"].eigenvalues(3) == pytest.approx(jacobi_eigenvalues(1.5, 3), rel=1e-6)
    assert 0.0 < done["u"].max() < 1.0
    assert done["walls"].volumes @ done["v"] == pytest.approx(4.0 / 3.0, rel=1e-5)


def test_the_disc(done):
    disc, w = done["disc"], done["w"]
    assert w.shape == disc.x.shape
    assert 0.0 < disc.total(w) < np.pi / 4.0


def test_the_blobs(done):
    later = done["later"]
    x = np.array([-3.0, 0.0, 0.2, 25.0, 50.0])
    narrow, wide = fp.green(x, 0.5 + 0.01**1.5, 1.5), fp.green(x - 50.0, 1.5, 1.5)
    assert later.at(x) == pytest.approx(narrow + wide, rel=1e-4)
    assert later.particles.x.size < 1500
