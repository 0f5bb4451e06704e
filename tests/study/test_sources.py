"""The files that a study is made of."""

from __future__ import annotations

from pathlib import Path

import fracparticles
from fracstudy.sources import sources_of

ROOT = Path(fracparticles.__file__).parents[2]


def names(module: str) -> set[str]:
    return {str(Path(path).relative_to(ROOT)) for path in sources_of(ROOT / module, ROOT)}


def test_what_is_imported_counts_at_any_depth():
    found = names("workflow/scenes/lucchesi/lucchesi_figure_2/study.py")
    assert {"src/fracstudy/inputs.py", "src/fracstudy/claims.py"} <= found
    assert {
        "src/fracparticles/special/stable.py",
        "src/fracparticles/special/chebyshev.py",
    } <= found
    assert "src/fracparticles/run/dataset.py" in found  # inside a function of inputs.py


def test_what_is_not_imported_does_not():
    found = names("src/fracstudy/inputs.py")
    assert "src/fracstudy/report.py" not in found


def test_what_a_package_finds_by_path_counts():
    found = names("src/fracparticles/run/solver.py")
    assert {"src/fracparticles/schemes/dd.py", "src/fracparticles/schemes/dpse.py"} <= found


def test_a_module_imported_from_its_package(tmp_path):
    root = tmp_path / "src/fracparticles"
    (root / "part").mkdir(parents=True)
    for name, text in {
        "a.py": "from fracparticles.part import b\nimport numpy",
        "part/b.py": "def f():\n    from fracparticles.part import thing",
        "part/__init__.py": "thing = 1",
        "part/c.py": "",
        "d.py": "",
    }.items():
        (root / name).write_text(text)
    found = sources_of(root / "a.py", tmp_path)
    parts = ("a.py", "part/__init__.py", "part/b.py", "part/c.py")
    assert found == [str(root / name) for name in parts]
    alone = sources_of(root / "a.py", tmp_path, ends=[root / "part/b.py"])
    assert alone == [str(root / name) for name in ("a.py", "part/b.py")]
