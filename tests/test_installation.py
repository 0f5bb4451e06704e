"""Where the package is installed: folders that cannot be written, no home, a damaged cache of compiled functions."""

from __future__ import annotations

import errno
import importlib
import importlib.util
import math
import os
import pkgutil
import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from numba.core.registry import CPUDispatcher

import fracparticles
from fracparticles import _compiled, _compiler
from scenes.extremes.faults.processes import forked
from sweeps import covering, few

PACKAGE = Path(fracparticles.__file__).parent
PEAK = math.gamma(1.0 + 1.0 / 1.5) / math.pi  # of the fundamental solution of alpha = 1.5 at t = 1
GREEN = "import fracparticles as fp; print(fp.green(0.0, 1.0, 1.5))"


@pytest.fixture
def site(tmp_path) -> Path:
    """A folder with a copy of the package, without anything compiled."""
    ignored = shutil.ignore_patterns("__pycache__")
    shutil.copytree(PACKAGE, tmp_path / "site" / "fracparticles", ignore=ignored)
    return tmp_path / "site"


def run(site: Path, program: str, **environment: str) -> subprocess.CompletedProcess[str]:
    """Run a program with the package in `site`, no home, and no folder for a cache but those named."""
    kept = {
        name: value
        for name, value in os.environ.items()
        if name not in ("HOME", "XDG_CACHE_HOME", "NUMBA_CACHE_DIR")
    }
    return subprocess.run(
        [sys.executable, "-B", "-c", program],
        env={**kept, "PYTHONPATH": str(site), "XDG_CACHE_HOME": "/dev/null", **environment},
        cwd=site,
        capture_output=True,
        text=True,
        check=False,
    )


def forbid_writing(site: Path) -> None:
    """Take the place of every cache: permissions alone do not stop the superuser."""
    for folder in [site / "fracparticles", *(site / "fracparticles").rglob("*/")]:
        (folder / "__pycache__").write_text("")


def peak(done: subprocess.CompletedProcess[str]) -> float:
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    return float(done.stdout)


@pytest.mark.parametrize("folder", [None, "/dev/null/none", "cache"])
def test_it_works_where_nothing_can_be_written(site, tmp_path, folder):
    """Each compiled function has the same cache, below: that one works shows it of all."""
    forbid_writing(site)
    if folder == "cache":  # what the user sets is used
        folder = str(tmp_path / "cache")
    said = {} if folder is None else {"NUMBA_CACHE_DIR": folder}
    assert peak(run(site, GREEN, **said)) == pytest.approx(PEAK, rel=1e-13)
    kept = list(tmp_path.joinpath("cache").rglob("*.nbc"))
    assert bool(kept) == (folder == str(tmp_path / "cache"))
    assert list(site.rglob("*.nb[ic]")) == []


def test_importing_the_package_imports_no_compiler():
    program = (
        "import sys, fracparticles; sys.exit(any(n.split('.')[0] == 'numba' for n in sys.modules))"
    )
    assert subprocess.run([sys.executable, "-c", program], check=False).returncode == 0


def test_every_compiled_function_has_that_cache():
    """One way to compile: no module takes numba's own; and each function has a folder for its code."""
    direct = re.compile(r"\b(nb|numba)\.(njit|jit|vectorize|guvectorize|cfunc|stencil)\b")
    others = [path for path in PACKAGE.rglob("*.py") if path.name != "_compiler.py"]
    assert [path.name for path in others if direct.search(path.read_text())] == []
    modules = [
        importlib.import_module(found.name)
        for found in pkgutil.walk_packages(fracparticles.__path__, "fracparticles.")
    ]
    values = [one for module in modules for one in vars(module).values()]
    compiled = [one for one in values if isinstance(one, (_compiled.Promise, CPUDispatcher))]
    assert compiled
    assert {type(one._cache) for one in compiled} == {_compiler._Cache}


def test_a_function_is_numbas_once_it_was_called(module):
    """So that a call costs no more than one of numba's; until then it is copied and pickled by its name."""
    function = load(module)
    space = function.__wrapped__.__globals__
    assert space["total"] is function
    assert function(np.arange(5.0)) == 10.0
    assert isinstance(space["total"], CPUDispatcher)
    assert function.compiled is space["total"]


def test_a_promise_is_copied_by_name():
    program = (
        "import copy, pickle, sys\n"
        "from fracparticles.time import stepping\n"
        "function = stepping.all_finite\n"
        "same = [copy.deepcopy(function), pickle.loads(pickle.dumps(function))]\n"
        "assert all(one is function for one in same) and 'numba' not in sys.modules"
    )
    assert subprocess.run([sys.executable, "-c", program], check=False).returncode == 0


CALLING = """\
from typing import NamedTuple

import inner
from fracparticles._compiled import njit


class Pair(NamedTuple):
    total: float


@njit()
def total(pair):  # calls itself as little as `pair.total` does
    return inner.times(pair.total)


@njit()
def outer(pair):
    return total(pair)
"""
CALLED = """\
from fracparticles._compiled import njit


@njit()
def times(x):
    return {factor} * x
"""


def test_an_edit_of_what_a_function_calls_is_noticed(tmp_path):
    """Of a module, too; and the name of an attribute is not taken for a call."""
    (tmp_path / "outer.py").write_text(CALLING)

    def called() -> int:
        sys.dont_write_bytecode = True
        sys.path.insert(0, str(tmp_path))
        from outer import Pair, outer

        print(outer(Pair(1.0)), hits(outer))
        return 0

    printed = []
    for factor, calls in (("2.0", 2), ("30.0", 1)):
        (tmp_path / "inner.py").write_text(CALLED.format(factor=factor))
        for _ in range(calls):
            printed.append(forked(called))
    assert printed == [(0, "2.0 0\n"), (0, "2.0 1\n"), (0, "30.0 0\n")]


# --- a damaged cache ------------------------------------------------------------------------------

MODULE = """\
from fracparticles._compiled import njit


@njit()
def total(values):
    result = 0.0
    for value in values:
        result += value
    return result
"""
DAMAGES = {
    "empty": lambda data: b"",
    "one byte": lambda data: data[:1],
    "a tenth": lambda data: data[: len(data) // 10],
    "half": lambda data: data[: len(data) // 2],
    "all but one": lambda data: data[:-1],
    "half of it zero": lambda data: data[: len(data) // 2] + bytes(len(data) - len(data) // 2),
    "zero": lambda data: bytes(len(data)),
    "text": lambda data: b"not a cache\n",
}


def load(path: Path):
    spec = importlib.util.spec_from_file_location("summing", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.total


def hits(function) -> int:
    return sum(function.stats.cache_hits.values())


@pytest.fixture(scope="module")
def compiled(tmp_path_factory) -> Path:
    """A folder with the module and its cache."""
    folder = tmp_path_factory.mktemp("compiled")
    (folder / "summing.py").write_text(MODULE)
    function = load(folder / "summing.py")
    assert function(np.arange(5.0)) == 10.0
    assert hits(function) == 0
    return folder


@pytest.fixture
def module(compiled, tmp_path) -> Path:
    """A copy of the module, with a cache that is taken."""
    shutil.copytree(compiled, tmp_path, dirs_exist_ok=True)
    function = load(tmp_path / "summing.py")
    assert function(np.arange(5.0)) == 10.0
    assert hits(function) == 1
    return tmp_path / "summing.py"


@pytest.mark.parametrize(("damage", "kind"), covering(DAMAGES, ["nbi", "nbc"]))
def test_a_damaged_cache_is_made_again(module, damage, kind):
    (file,) = module.parent.rglob(f"*.{kind}")
    file.write_bytes(DAMAGES[damage](file.read_bytes()))
    for cached in (0, 1):
        function = load(module)
        assert function(np.arange(5.0)) == 10.0
        assert hits(function) == cached


@pytest.mark.parametrize("share", few([0.1, 0.3, 0.5, 0.7, 0.9]))
def test_code_with_a_changed_bit_is_not_run(module, share):
    (file,) = module.parent.rglob("*.nbc")
    data = bytearray(file.read_bytes())
    data[int(share * len(data))] ^= 1
    file.write_bytes(data)
    for cached in (0, 1):
        function = load(module)
        assert function(np.arange(5.0)) == 10.0
        assert hits(function) == cached


def test_code_of_another_version_is_not_run(module):
    """A process that was killed between the two files leaves a new index and old code."""
    (code,) = module.parent.rglob("*.nbc")
    old = code.read_bytes()
    module.write_text(MODULE.replace("+= value", "+= 3.0 * value"))
    os.utime(module, (1.0, 1.0))
    assert load(module)(np.arange(5.0)) == 30.0
    code.write_bytes(old)
    for cached in (0, 1):
        function = load(module)
        assert function(np.arange(5.0)) == 30.0
        assert hits(function) == cached


def test_a_damaged_cache_that_cannot_be_mended_is_left_alone(module, monkeypatch):
    (file,) = module.parent.rglob("*.nbi")
    file.write_bytes(b"")

    def fail(*_):
        raise OSError(errno.EROFS, os.strerror(errno.EROFS))

    function = load(module)
    monkeypatch.setattr(function._cache._cache_file, "_save_index", fail)
    assert function(np.arange(5.0)) == 10.0
    assert file.read_bytes() == b""


@pytest.mark.parametrize("number", [errno.ENOSPC, errno.EACCES, errno.EDQUOT])
def test_a_cache_that_cannot_be_written_stops_nothing(tmp_path, monkeypatch, number):
    path = tmp_path / "summing.py"
    path.write_text(MODULE)

    def fail(*_):
        raise OSError(number, os.strerror(number))

    function = load(path)
    monkeypatch.setattr(function._cache._cache_file, "_save_data", fail)
    assert function(np.arange(5.0)) == 10.0
    again = load(path)  # the index names data that are not there
    assert again(np.arange(5.0)) == 10.0


def test_the_packages_own_cache_cut_in_half(site):
    right = peak(run(site, GREEN))
    assert right == pytest.approx(PEAK, rel=1e-13)
    cached = sorted(site.rglob("*.nb[ic]"))
    assert cached
    for file in cached:
        file.write_bytes(file.read_bytes()[: file.stat().st_size // 2])
    cut = [file.stat().st_size for file in cached]
    assert peak(run(site, GREEN)) == right
    assert all(file.stat().st_size > size for file, size in zip(cached, cut, strict=True))


def test_options_reach_the_compiler():
    def twice(x):
        return 2.0 * x

    assert _compiled.njit()(twice).targetoptions["nogil"]
    assert not _compiled.njit(nogil=False)(twice).targetoptions["nogil"]
    assert _compiled.njit(inline="always")(twice)(1.5) == 3.0
