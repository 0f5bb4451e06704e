"""Files that are damaged: a run that is read, initial data, the cache of compiled functions."""

from __future__ import annotations

import importlib.util
import os
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np

from fracparticles.errors import InvalidInput
from fracparticles.run.cli import main
from fracparticles.run.dataset import read_run
from fracparticles.run.solver import compute
from fracstudy.probe import HELD, REFUSED, Kind, Probe
from scenes.extremes.faults.processes import counted, forked
from scenes.extremes.faults.writing import Setup, one_line

__all__ = ["of_the_cache", "of_the_run"]

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

    def many(case: str, expected: str, of: list[bytes], look: Callable[[bytes], bool]) -> Probe:
        return Kind("damaged run", expected, must=HELD)(case, lambda: counted(map(look, of)))

    cut = [right[: len(right) * part // parts] for part in range(parts)]
    lost = [data + right[len(data) + 1 :] for data in cut]
    changed = [_changed(right, *place) for place in _places(len(right), flips, seed)]
    expected = "refused in a line, or the same numbers"
    yield many(f"cut at 0, 1, .. of {parts} parts", expected, cut, judged)
    yield many(f"a bit changed, {flips} times", expected, changed, judged)
    yield many("a byte lost at the same places", expected, lost, judged)

    def shown(data: bytes) -> bool:
        copy.write_bytes(data)
        status, text = forked(lambda: main(["show", str(copy)]))
        return status == 2 and one_line(text)

    yield many("shown, command line", "status 2 and a line", [*cut[::4], *changed[:2]], shown)
    damaged_run = Kind("damaged run", must=REFUSED)
    for case, data in (
        ("empty", b""),
        ("text", b"not a run\n"),
        ("zeros", bytes(len(right))),
        ("half of it zero", right[: len(right) // 2] + bytes(len(right) - len(right) // 2)),
    ):
        for use, look in (
            ("read", read_run),
            ("as initial data", lambda path: compute(setup.case, path)),
        ):
            yield damaged_run(f"{case}, {use}", _used, look, copy, data)
    copy.unlink(missing_ok=True)
    for case, path in (("none", copy), ("a directory", setup.folder)):
        yield damaged_run(case, _used, read_run, path)


def _used(look: Callable[[Path], object], path: Path, data: bytes | None = None) -> float:
    if data is not None:
        path.write_bytes(data)
    look(path)
    return np.nan


def _places(size: int, count: int, seed: int) -> list[tuple[int, int]]:
    rng = np.random.default_rng(seed)
    return [(int(rng.integers(size)), int(rng.integers(8))) for _ in range(count)]


def _changed(data: bytes, place: int, bit: int) -> bytes:
    changed = bytearray(data)
    changed[place] ^= 1 << bit
    return bytes(changed)


def of_the_cache(folder: Path, flips: int, parts: int, seed: int) -> Iterator[Probe]:
    """The sum of 0, .., 4 by a compiled function, whose index or code is cut, changed, of another version."""
    folder.mkdir()
    source = folder / "summing.py"
    os.environ.pop("NUMBA_CACHE_DIR", None)

    def compiled(factor: float) -> dict[str, bytes]:
        source.write_text(MODULE.format(factor=factor))
        os.utime(source, (factor, factor))
        forked(_sum(source, 10.0 * factor))
        return {path.name: path.read_bytes() for path in folder.rglob("*.nb[ic]")}

    old, new = compiled(1.0), compiled(3.0)

    def right(damaged: dict[str, bytes], factor: float = 3.0) -> bool:
        for path in folder.rglob("*.nb[ic]"):
            path.unlink()
        for name, data in {**new, **damaged}.items():
            (folder / "__pycache__" / name).write_bytes(data)
        # twice: the second time with what the first one kept
        return all(forked(_sum(source, 10.0 * factor)) == (0, "") for _ in range(2))

    def row(case: str, damages: list[dict[str, bytes]]) -> Probe:
        return Kind("damaged cache", "3 (0 + 1 + 2 + 3 + 4) = 30", source="closed form", must=HELD)(
            case, lambda: counted(map(right, damages))
        )

    cut = [
        {name: data[: len(data) * k // parts]} for name, data in new.items() for k in range(parts)
    ]
    yield row(f"index and code cut at 0, 1, .. of {parts} parts", cut)
    changed = [
        {name: _changed(data, *place)}
        for name, data in new.items()
        for place in _places(len(data), flips // 2, seed)
    ]
    yield row(f"a bit changed, {len(changed)} times", changed)
    code = [name for name in new if name.endswith(".nbc")]
    yield row(
        "the index is new, the code is old", [{name: old[name] for name in code if name in old}]
    )


def _sum(source: Path, expected: float) -> Callable[[], int]:
    def work() -> int:
        spec = importlib.util.spec_from_file_location("summing", source)
        assert spec is not None
        assert spec.loader is not None
        module = importlib.util.module_from_spec(spec)
        sys.dont_write_bytecode = True
        spec.loader.exec_module(module)
        return int(module.total(np.arange(5.0)) != expected)

    return work
