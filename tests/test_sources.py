"""The files that a study is made of."""

from __future__ import annotations

from pathlib import Path

import fracparticles
from fracparticles.sources import sources_of

ROOT = Path(fracparticles.__file__).parent


def names(module: str) -> set[str]:
    return {str(Path(path).relative_to(ROOT)) for path in sources_of(ROOT / module, ROOT)}


def test_what_is_imported_counts_at_any_depth():
    found = names("studies/reference_case.py")
    assert {"studies/reference_case.py", "studies/common.py", "claims.py"} <= found
    assert {
        "special/stable.py",
        "special/chebyshev.py",
    } <= found  # the latter imported by the former
    assert "dataset.py" in found  # inside a function of studies/common.py


def test_what_is_not_imported_does_not():
    found = names("studies/common.py")
    assert not any(name.startswith("figures") for name in found)
    assert "studies/extreme.py" not in found


def test_a_module_imported_from_its_package(tmp_path):
    (tmp_path / "part").mkdir()
    for name, text in {
        "a.py": "from fracparticles.part import b\nimport numpy",
        "part/b.py": "def f():\n    from fracparticles.part import thing",
        "part/__init__.py": "thing = 1",
        "part/c.py": "",
    }.items():
        (tmp_path / name).write_text(text)
    found = sources_of(tmp_path / "a.py", tmp_path)
    assert found == [str(tmp_path / name) for name in ("a.py", "part/__init__.py", "part/b.py")]
    alone = sources_of(tmp_path / "a.py", tmp_path, ends=[tmp_path / "part/b.py"])
    assert alone == [str(tmp_path / name) for name in ("a.py", "part/b.py")]
