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


def test_functions_of_other_arguments_are_coefficients(done):
    decay = np.exp(-0.1 * (1.0 - np.exp(-0.5)))
    assert float(done["spread"].mass) == pytest.approx(np.sqrt(np.pi) * decay, rel=40.0**-1.5)


def test_what_all_varies_between_absorbing_ends(done):
    between = done["between"]
    assert fp.Problem.from_json(between.attrs["problem"]) == done["ends"]
    assert 0.0 < float(between.mass) < 4.0 / 3.0
    assert float(abs(between.u[0])) < 1e-6
    assert str(between.integrator.values) == "radau"


def test_walls_keep_the_mass(done):
    kept = done["kept"]
    assert float(kept.mass_final) == pytest.approx(float(kept.mass_initial), rel=1e-12)


def test_the_disc_that_turns_has_turned(done):
    """By 0.2, about what does not turn: the first moments are those, turned."""
    turned, still = (
        done["turned"],
        fp.solve_problem(
            done["turning"].model_copy(update={"velocity": None}),
            lambda x, y: np.exp(-8.0 * ((x - 0.3) ** 2 + y**2)),
        ),
    )
    z = (turned.volume * turned.u * (turned.x + 1j * turned.y)).sum().values
    z0 = (still.volume * still.u * (still.x + 1j * still.y)).sum().values
    assert abs(z - z0 * np.exp(0.2j)) < 1e-6


def test_the_square_follows_what_is_outside(done):
    swung = done["swung"]
    edge = float(swung.u.isel(x=0).sel(y=0.0, method="nearest"))
    assert edge == pytest.approx(np.cos(0.2) / 2.0, abs=0.05)


def test_the_domains_beneath(done):
    assert done["interval"].eigenvalues(3) == pytest.approx(jacobi_eigenvalues(1.5, 3), rel=1e-6)
    assert 0.0 < done["u"].max() < 1.0
    disc, w, r = done["disc"], done["w"], done["r"]
    assert w.shape == disc.x.shape
    assert (w > 0.5).all()
    assert ((r >= 0.1 - 1e-4) & (r < 0.16)).all()


def test_the_blobs(done):
    later = done["later"]
    x = np.array([-3.0, 0.0, 0.2, 25.0, 50.0])
    narrow, wide = fp.green(x, 0.5 + 0.01**1.5, 1.5), fp.green(x - 50.0, 1.5, 1.5)
    assert later.at(x) == pytest.approx(narrow + wide, rel=1e-4)
    assert later.particles.x.size < 1500
