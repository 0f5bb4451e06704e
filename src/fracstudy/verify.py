"""Recompute a sample of the tracked results, and compare: `make verify`.

    python -m fracstudy.verify [--seed N] [--scenes N]

The sample is drawn with a seed, at least one scene of each document. It leaves out scenes with run times, which differ
from run to run, and scenes that read the tables of others. A file must agree byte for byte. If another machine rounds
differently, the numbers of a table may differ by 1e-6 of each, or by 1e-9 if they are round-off themselves. The figure
of such a table is then another drawing.
"""

from __future__ import annotations

import argparse
import random
import re
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from fracstudy.config import read_project
from fracstudy.scene import Scene

__all__ = ["agreement", "compare", "main", "sample"]

_RELATIVE, _ABSOLUTE = 1e-6, 1e-9  # by which numbers of a table may differ
_NUMBER = re.compile(r"[-+]?\d+(?:\.\d*)?(?:e[-+]?\d+)?")
SAME, CLOSE, DIFFERS = "same bytes", "same to round-off", "DIFFERS"


def sample(scenes: Mapping[str, Scene], count: int, seed: int) -> list[str]:
    """Return `count` scenes, at least one of each document, none of which needs run times or other scenes."""
    rng = random.Random(seed)
    timeless = [n for n, scene in scenes.items() if not scene.all_benchmarks and not scene.tables]
    documents: dict[str, list[str]] = {}
    for name in timeless:
        documents.setdefault(scenes[name].document, []).append(name)
    drawn = [rng.choice(names) for names in documents.values()]
    others = [name for name in timeless if name not in drawn]
    return drawn + rng.sample(others, max(0, min(count - len(drawn), len(others))))


def agreement(tracked: str, made: str) -> str:
    """Return in words whether two tables agree in their bytes, in their numbers to round-off, or not."""
    if tracked == made:
        return SAME
    if _NUMBER.sub("#", tracked) != _NUMBER.sub("#", made):
        return DIFFERS
    ours, theirs = (np.array(_NUMBER.findall(text), dtype=float) for text in (made, tracked))
    close = np.allclose(ours, theirs, rtol=_RELATIVE, atol=_ABSOLUTE)
    return CLOSE if close else DIFFERS


def compare(names: Sequence[str], tracked: Path, made: Path) -> pd.DataFrame:
    """Return one row for each file of the scenes, with its agreement with the tracked one."""
    rows = []
    for name in names:
        table = f"tables/{name}.csv"
        found = agreement((tracked / table).read_text("utf-8"), (made / table).read_text("utf-8"))
        rows.append((name, table, found))
        for figure in sorted(tracked.glob(f"figures/{name}.svg")):
            same = figure.read_bytes() == (made / "figures" / figure.name).read_bytes()
            words = SAME if same else "another drawing" if found != SAME else DIFFERS
            rows.append((name, f"figures/{figure.name}", words))
    return pd.DataFrame(rows, columns=["scene", "file", "agreement"])


def main(arguments: Sequence[str] | None = None) -> int:
    """Draw a sample, recompute it in a temporary folder, print the comparison; 1 if anything differs."""
    parser = argparse.ArgumentParser(description="Recompute a sample of the tracked results.")
    parser.add_argument("--seed", type=int, default=0, help="of the sample")
    parser.add_argument("--scenes", type=int, default=10, help="how many")
    given = parser.parse_args(arguments)
    study, scenes = read_project(Path())
    names = sample(scenes, given.scenes, given.seed)
    print(f"seed {given.seed}: {', '.join(names)}")
    with tempfile.TemporaryDirectory() as folder:
        made = Path(folder) / "results"
        places = [f"results_dir={made}", f"report_dir={folder}/report", f"site_dir={folder}/site"]
        call = [sys.executable, "-m", "snakemake", "-j2"]
        # The names go before the options, which may take several values.
        done = subprocess.run([*call, *names, "--quiet", "all", "--config", *places], check=False)
        if done.returncode:
            return done.returncode
        table = compare(names, Path(study.results_dir), made)
    print(table.to_markdown(index=False))
    return int((table["agreement"] == DIFFERS).any())


if __name__ == "__main__":
    sys.exit(main())
