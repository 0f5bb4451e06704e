"""Faults: what is killed, full, read-only, damaged or changed, and what the next call makes of it."""

from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

from fracstudy.inputs import Inputs, Result
from fracstudy.probe import Probe, frame
from scenes.extremes.faults import damage, workflows, writing


def study(
    inputs: Inputs,
    *,
    kills: int,
    interrupts: int,
    flips: int,
    parts: int,
    seed: int,
    workflow: bool,
) -> Result:
    """One row a fault, done as often as it says; the moments and the places are drawn from the seed.

    Afterwards the same call is made again, and has to end as if nothing had been: with the same bytes, and no other
    file in the folder.
    """
    with TemporaryDirectory() as name:
        table = frame(_probes(Path(name), kills, interrupts, flips, parts, seed, workflow))
        table["found"] = table["found"].str.replace(f"{name}/", "")
        return Result(table)


def _probes(
    folder: Path, kills: int, interrupts: int, flips: int, parts: int, seed: int, workflow: bool
) -> Iterator[Probe]:
    setup = writing.Setup(folder)
    yield from writing.probes(setup, kills, interrupts, parts, seed)
    yield from damage.of_the_run(setup, flips, parts, seed)
    yield from damage.of_the_cache(folder / "cache", flips // 5, max(2, parts // 4), seed)
    if workflow:
        yield from workflows.probes(folder / "workflow", Path.cwd())
