"""Faults: what is killed, full, read-only, damaged or changed, and what the next call makes of it."""

from pathlib import Path
from tempfile import TemporaryDirectory

from fracstudy.inputs import Inputs, Result
from fracstudy.probe import frame, probes_of
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
        folder, modules = Path(name), (writing, damage, *([workflows] if workflow else []))
        given = {"kills": kills, "interrupts": interrupts, "flips": flips, "parts": parts}
        setup = writing.Setup(folder)
        table = frame(probes_of(*modules, folder=folder, setup=setup, seed=seed, **given))
        table["found"] = table["found"].str.replace(f"{name}/", "")
        return Result(table)
