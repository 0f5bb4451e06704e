"""Run the benchmarks of scenes."""

import sys
from typing import Any

from fracparticles.run.dataset import write
from fracstudy.scene import Scene

snakemake: Any
sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)  # noqa: SIM115

for given, path in zip(snakemake.params.scenes, snakemake.output, strict=True):
    scene = Scene(**given)
    write(scene.function("benchmark")(**scene.benchmark), path)
