"""The examples of CONTRIBUTING.md work as they stand there, in a copy of the project."""

from __future__ import annotations

import re
from pathlib import Path

import pandas as pd
import pytest

from copies import answer, copy_packages
from fracstudy.findings import measured
from fracstudy.ledger import ledger
from fracstudy.printed import read_printed
from fracstudy.verdicts import Status

ROOT = Path(__file__).resolve().parents[1]
TEXT = (ROOT / "CONTRIBUTING.md").read_text("utf-8")
FILES = dict(re.findall(r"^```\w+\n# (\S+)\n(.*?)^```", TEXT, re.DOTALL | re.MULTILINE))
(RK3,) = re.findall(r'^    "rk3": .*\n', TEXT, re.MULTILINE)

PROGRAM = """
import json, sys, warnings
from pathlib import Path
import numpy as np
import fracparticles as fp
from fracparticles.run.solver import compute
from fracstudy.make import make
from fracstudy.scene_files import read_scenes

warnings.simplefilter("ignore")
fields = {"beta": 0.5, "half_width": 20.0, "integrator": "exponential", "exterior": "truncated"}

def evolved(**given):
    # A blob, against the exact symbol.
    case = fp.Case(t_initial=0.0, t_final=1.0, **{**fields, "exterior": "open", **given})
    run = compute(case, lambda x: np.exp(-x * x))
    exact = fp.evolve(run.u0, case.particle_spacing, alpha=1.5, time=1.0)
    return float(np.abs(run.u - exact)[np.abs(run.x) < 5.0].max())

def stepped(dt, integrator="rk3", evaluation="stepping"):
    ours = {"integrator": integrator, "dt": dt, "evaluation": evaluation}
    return compute(fp.Case(scheme="KPSE", spacing=0.25, **{**fields, **ours})).u

exact = compute(fp.Case(scheme="KPSE", spacing=0.25, **fields)).u
scenes = read_scenes(Path("scenes").resolve(), ["beyond"], smoke=False)
files = []
for case in scenes["gain"].cases:
    fp.write(fp.solve(case), Path("runs") / case.path)
    files.append(str(Path("runs") / case.path))
make(scenes["gain"], Path("results"), files, None, ["svg"])
scene = Path("scenes/beyond/gain/figure.py")
scene.write_text(scene.read_text().replace("table", "series"))
del sys.modules["scenes.beyond.gain.figure"]
try:
    make(read_scenes(Path("scenes").resolve(), ["beyond"], smoke=False)["gain"], Path("results"), files, None, ["svg"])
except fp.FracparticlesError as error:
    refused = str(error)
print(json.dumps({
    "file": fp.__file__,
    "refused": refused,
    "errors": [evolved(scheme="XPSE", spacing=h) for h in (0.2, 0.1)],
    "limits": [fp.stability_limit(name, 0.5) for name in ("XPSE", "KPSE")],
    "steps": [float(np.abs(stepped(dt) - exact).max()) for dt in (0.04, 0.02)],
    "series": float(np.abs(stepped(0.02, evaluation="series") - stepped(0.02)).max()),
    "largest": [fp.Case(scheme="KPSE", spacing=0.25, **{**fields, "integrator": name, "dt": 0.01}).largest_stable_step
                for name in ("rk3", "rk2")],
    "smeared": float(fp.solve(fp.Case(scheme="SMEAR", spacing=0.25, **fields)).mass_final),
}))
"""


@pytest.fixture(scope="module")
def found(tmp_path_factory) -> dict:
    """What a program says that runs with a copy of the sources and the examples in it."""
    copy = tmp_path_factory.mktemp("copy")
    copy_packages(copy)
    for name, text in FILES.items():
        place = copy / name.removeprefix("src/").removeprefix("workflow/")
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_text(text, encoding="utf-8")
    for name, old in (
        ("time/polynomial.py", '    "rk4": StepPolynomial('),
        ("run/parameters.py", '"rk2", "rk4"'),
    ):
        module = copy / "fracparticles" / name
        text = module.read_text("utf-8")
        assert text.count(old) == 1
        new = RK3 + old if "Step" in old else '"rk2", "rk3", "rk4"'
        module.write_text(text.replace(old, new), encoding="utf-8")
    said = answer(copy, PROGRAM)
    said["figure"] = (copy / "results/figures/gain.svg").read_text("utf-8")
    said["table"] = pd.read_csv(copy / "results/tables/gain.csv")
    return said


def test_the_scheme_is_of_fourth_order_and_has_a_stability_limit(found):
    coarse, fine = found["errors"]
    assert coarse / fine == pytest.approx(16.0, rel=0.2)
    assert found["limits"][0] < found["limits"][1]  # its symbol is larger: (4 - 2^-alpha) / 3


def test_the_kernel_is_that_of_an_exchange_which_conserves(found):
    assert found["smeared"] == pytest.approx(1.0, abs=0.02)


def test_the_integrator_is_of_third_order_stepping_and_as_a_series(found):
    coarse, fine = found["steps"]
    assert coarse / fine == pytest.approx(8.0, rel=0.2)
    assert found["series"] < 1e-12
    assert found["largest"][0] / found["largest"][1] == pytest.approx(2.5127453266183286 / 2.0)


def test_the_scene_makes_its_table(found):
    assert list(found["table"].columns) == ["spacing", "gain"]
    assert (found["table"]["gain"] < 1.0).all()


def test_the_scene_draws_its_table_and_what_it_has_no_series_for_is_told(found):
    assert "<svg" in found["figure"]
    assert found["refused"].startswith(
        "gain: figure.py draws the series, and study.py returns none."
    )


def test_the_claim_is_judged_by_what_the_scene_measures(found, tmp_path):
    printed = tmp_path / "gain.yaml"
    printed.write_text(FILES["report/printed/lucchesi/gain.yaml"])
    for gains, status in (
        (found["table"]["gain"], Status.REPRODUCED),
        ([1.5, 2.0], Status.REFUTED),
    ):
        finding = measured("L-C99.gain", gain=gains)
        (row,) = ledger(read_printed(printed), [finding], {}).to_dict("records")
        assert row["status"] == status
