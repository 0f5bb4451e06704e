"""Files that are damaged: a run that is read, initial data, the cache of compiled functions."""

import importlib.util
import os
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
from numba import njit

from fracparticles.command_line.cli import main
from fracparticles.errors import InvalidInput
from fracparticles.run.dataset import read_run
from fracparticles.run.solver import compute
from fracstudy.probe import HELD, REFUSED, Kind, Probe
from scenes.extremes.faults.processes import counted, forked
from scenes.extremes.faults.writing import Setup, one_line

MODULE = """\
from fracparticles._compiled import njit


@njit()
def total(values):
    result = 0.0
    for value in values:
        result += {factor} * value
    return result
"""


def of_the_run(setup: Setup, flips: int, parts: int, seed: int) -> Iterator[Probe]:
    """A file cut at every tenth, with a byte changed, empty, of text; read, shown, taken for initial data."""
    setup.afresh()
    setup.run()
    right, whole = setup.right, read_run(setup.path)
    copy = setup.folder / "damaged.nc"

    def judged(data: bytes) -> bool:
        """Whether it is refused, or holds what was written."""
        copy.write_bytes(data)
        try:
            return read_run(copy).identical(whole)
        except InvalidInput as error:
            return "\n" not in str(error)

    def shown(data: bytes) -> bool:
        copy.write_bytes(data)
        status, text = forked(lambda: main(["show", str(copy)]))
        return status == 2 and one_line(text)

    cut = [right[: len(right) * part // parts] for part in range(parts)]
    lost = [data + right[len(data) + 1 :] for data in cut]
    changed = [_changed(right, *place) for place in _places(len(right), flips, seed)]
    same = Kind("damaged run", "refused in a line, or the same numbers", must=HELD)
    for case, damaged in {
        f"cut at 0, 1, .. of {parts} parts": cut,
        f"a bit changed, {flips} times": changed,
        "a byte lost at the same places": lost,
    }.items():
        yield same(case, lambda: counted(map(judged, damaged)))
    line = Kind("damaged run", "status 2 and a line", must=HELD)
    few = [*cut[::4], *changed[:2]]
    yield line("shown, command line", lambda: counted(map(shown, few)))
    refused, half = Kind("damaged run", must=REFUSED), len(right) // 2
    for case, data in {
        "empty": b"",
        "text": b"not a run\n",
        "zeros": bytes(len(right)),
        "half of it zero": right[:half] + bytes(len(right) - half),
    }.items():
        copy.write_bytes(data)
        yield refused(f"{case}, read", read_run, copy)
        yield refused(f"{case}, as initial data", compute, setup.case, copy)
    copy.unlink(missing_ok=True)
    for case, path in (("none", copy), ("a directory", setup.folder)):
        yield refused(case, read_run, path)


def _places(size: int, count: int, seed: int) -> list[tuple[int, int]]:
    rng = np.random.default_rng(seed)
    return [(int(rng.integers(size)), int(rng.integers(8))) for _ in range(count)]


def _changed(data: bytes, place: int, bit: int) -> bytes:
    changed = bytearray(data)
    changed[place] ^= 1 << bit
    return bytes(changed)


def of_the_cache(folder: Path, flips: int, parts: int, seed: int) -> Iterator[Probe]:
    """The sum of 0, .., 4 by a compiled function, whose index or code is cut, changed, of another version."""
    folder, flips, parts = folder / "cache", flips // 5, max(2, parts // 4)
    folder.mkdir()
    source = folder / "summing.py"
    # What the compiler loads at its first use is there for all that begin here.
    njit(_added)(np.arange(5.0))
    os.environ.pop("NUMBA_CACHE_DIR", None)

    def compiled(factor: float) -> dict[str, bytes]:
        source.write_text(MODULE.format(factor=factor))
        os.utime(source, (factor, factor))
        forked(_sum(source, 10.0 * factor))
        return {path.name: path.read_bytes() for path in folder.rglob("*.nb[ic]")}

    old, new = compiled(1.0), compiled(3.0)

    def right(damaged: dict[str, bytes]) -> bool:
        for path in folder.rglob("*.nb[ic]"):
            path.unlink()
        for name, data in {**new, **damaged}.items():
            (folder / "__pycache__" / name).write_bytes(data)
        # twice: the second time with what the first one kept
        return all(forked(_sum(source, 30.0)) == (0, "") for _ in range(2))

    cut: list[dict[str, bytes]] = []
    changed: list[dict[str, bytes]] = []
    for name, data in new.items():
        cut += [{name: data[: len(data) * k // parts]} for k in range(parts)]
        changed += [{name: _changed(data, *at)} for at in _places(len(data), flips // 2, seed)]
    code = {name: data for name, data in old.items() if name in new and name.endswith(".nbc")}
    same = Kind("damaged cache", "3 (0 + 1 + 2 + 3 + 4) = 30", 0.0, "closed form", HELD)
    for case, damages in {
        f"index and code cut at 0, 1, .. of {parts} parts": cut,
        f"a bit changed, {len(changed)} times": changed,
        "the index is new, the code is old": [code],
    }.items():
        yield same(case, lambda: counted(map(right, damages)))


def _added(values: np.ndarray) -> float:
    total = 0.0
    for value in values:
        total += value
    return total


def _sum(source: Path, expected: float) -> Callable[[], int]:
    def work() -> int:
        spec = importlib.util.spec_from_file_location("summing", source)
        assert spec is not None and spec.loader is not None  # noqa: PT018
        module = importlib.util.module_from_spec(spec)
        sys.dont_write_bytecode = True
        spec.loader.exec_module(module)
        return int(module.total(np.arange(5.0)) != expected)

    return work
