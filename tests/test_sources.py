"""The files that a study is made of."""

from __future__ import annotations

from pathlib import Path

import fracparticles
from fracstudy.sources import sources_of

ROOT = Path(fracparticles.__file__).parents[1]


def names(module: str) -> set[str]:
    return {str(Path(path).relative_to(ROOT)) for path in sources_of(ROOT / module, ROOT)}


def test_what_is_imported_counts_at_any_depth():
    found = names("fracstudy/studies/reference_case.py")
    assert {
        "fracstudy/studies/reference_case.py",
        "fracstudy/inputs.py",
        "fracstudy/claims.py",
    } <= found
    assert {
        "fracparticles/special/stable.py",
        "fracparticles/special/chebyshev.py",
    } <= found  # the latter imported by the former
    assert "fracparticles/run/dataset.py" in found  # inside a function of inputs.py


def test_what_is_not_imported_does_not():
    found = names("fracstudy/inputs.py")
    assert not any(name.startswith("fracstudy/figures") for name in found)
    assert "fracstudy/studies/extreme.py" not in found


def test_a_module_imported_from_its_package(tmp_path):
    root = tmp_path / "fracparticles"
    (root / "part").mkdir(parents=True)
    for name, text in {
        "a.py": "from fracparticles.part import b\nimport numpy",
        "part/b.py": "def f():\n    from fracparticles.part import thing",
        "part/__init__.py": "thing = 1",
        "part/c.py": "",
    }.items():
        (root / name).write_text(text)
    found = sources_of(root / "a.py", tmp_path)
    assert found == [str(root / name) for name in ("a.py", "part/__init__.py", "part/b.py")]
    alone = sources_of(root / "a.py", tmp_path, ends=[root / "part/b.py"])
    assert alone == [str(root / name) for name in ("a.py", "part/b.py")]
