"""How times and memory are measured."""

from __future__ import annotations

import subprocess
import sys
import time

import numpy as np
import pyfftw
from threadpoolctl import threadpool_limits

import fracparticles as fp
from fracparticles.run.dataset import read_benchmark, write
from fracparticles.schemes.stability import _symbol_range, stability_limit
from fracstudy.race import clock
from scene_functions import scenes


def test_an_action_is_repeated_until_the_time_is_up():
    timing, result = clock.measure(lambda: 7, repeats=5)
    assert result == 7
    assert len(timing.times) == 5
    assert timing.minimum <= timing.median <= max(timing.times)
    short, _ = clock.measure(lambda: None, repeats=100, seconds=0.0)
    assert len(short.times) == 1
    assert len((timing + short).times) == 6


def test_what_is_done_before_an_action_is_not_timed():
    done: list[int] = []

    def before() -> None:
        done.append(1)
        time.sleep(0.02)

    timing, _ = clock.measure(lambda: None, repeats=3, before=before)
    assert len(done) == 3
    assert timing.minimum < 0.02


def test_tables_are_forgotten():
    stability_limit("KPSE", 0.5)
    assert _symbol_range.cache_info().currsize > 0
    clock.forget_tables()
    forgotten = pyfftw.export_wisdom()[0]
    assert _symbol_range.cache_info().currsize == 0
    pyfftw.FFTW(pyfftw.zeros_aligned(346), pyfftw.zeros_aligned(174, dtype=complex))
    assert len(pyfftw.export_wisdom()[0]) > len(forgotten)


def test_a_benchmark_takes_one_thread_of_blas():
    with threadpool_limits(2):
        assert clock.machine()["threads_blas"] == 2
        clock.one_core()
        assert clock.machine()["threads_blas"] == 1


def test_peak_memory_is_that_of_a_process_of_its_own():
    """An interpreter with numpy and numba takes some hundred megabytes; what is here must not count."""
    here = np.ones(60_000_000)
    assert 2e7 < clock.in_fresh_process(clock.peak_so_far) < here.nbytes


def test_a_peak_begins_anew():
    here = np.ones(2**25)
    before = here.nbytes
    del here
    high = clock.peak_so_far()
    clock.forget_peak()
    assert clock.peak_so_far() < high - 0.9 * before


def test_rows_become_a_data_set_and_a_frame(tmp_path):
    rows = [{"name": "a", "x": 1.0, "what": ""}, {"name": "b", "what": "broken"}]
    data = clock.timings_dataset(
        "row", rows, {"name": "a name"}, {"x": ("a number", "s"), "what": ("a text", "1")}, "t", {"repeats": 3}
    )  # fmt: skip
    write(data, tmp_path / "rows.nc")
    frame = read_benchmark(tmp_path / "rows.nc")
    assert list(frame["name"]) == ["a", "b"]
    assert list(frame["what"]) == ["", "broken"]
    assert frame["x"][0] == 1.0
    assert np.isnan(frame["x"][1])
    assert frame.attrs["repeats"] == 3
    for fact in (
        "cpu",
        "cores",
        "threads_numba",
        "threads_blas",
        "python",
        "numpy",
        "pyfftw",
        "load_average",
        "other_load",
    ):
        assert fact in frame.attrs, fact


def test_a_benchmark_says_the_commit_as_a_run_does():
    """Package, version and, in a checkout, the commit."""
    case = fp.Case(scheme="KPSE", beta=0.5, half_width=8.0, spacing=0.5, integrator="exponential")
    data = clock.timings_dataset("row", [{"x": 1.0}], {}, {"x": ("a number", "s")}, "t", {})
    assert data.attrs["source"] == fp.solve(case).attrs["source"]
    assert data.attrs["source"].startswith(f"fracparticles {fp.__version__}")


def test_what_was_measured_elsewhere_says_its_own_facts():
    data = clock.timings_dataset("row", [], {}, {}, "t", {"threads_numba": 3})
    assert data.attrs["threads_numba"] == 3
    assert data.attrs["threads_blas"] == clock.conditions()["threads_blas"]


def test_the_load_of_others_is_that_beside_the_clock():
    """Another process that counts takes a core, or its share of one; what this process takes does not count."""
    busy = [sys.executable, "-c", "while True: pass"]
    clock.one_core()
    assert np.isnan(clock.other_load())
    with subprocess.Popen(busy) as other:
        time.sleep(0.2)  # until it has begun
        clock.measure(lambda: time.sleep(0.5))
        other.kill()
    assert clock.other_load() > 0.4
    before = clock.other_load()
    clock.one_core()
    clock.measure(lambda: sum(range(10_000_000)))
    assert clock.other_load() < before + 0.5


def test_every_benchmark_is_found():
    measured = [scene for scene in scenes().values() if scene.benchmark is not None]
    assert {"work_precision", "reference_times"} <= {scene.name for scene in measured}
    for scene in measured:
        assert callable(scene.function("benchmark"))
