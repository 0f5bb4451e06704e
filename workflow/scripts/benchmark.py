"""Run the benchmark of a scene."""

import sys
from typing import Any

from fracparticles.run.dataset import write
from fracstudy.scene import Scene

snakemake: Any
sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)  # noqa: SIM115

scene = Scene(**snakemake.params.scene)
write(scene.function("benchmark")(**scene.benchmark), snakemake.output[0])
