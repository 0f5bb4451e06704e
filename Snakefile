# Particle methods for fractional diffusion: the whole study. See README.md; keys in config/README.md.
from snakemake.utils import min_version

min_version("9.0")


configfile: "config/study.yaml"


include: "workflow/rules/common.smk"
include: "workflow/rules/runs.smk"
include: "workflow/rules/scenes.smk"
include: "workflow/rules/benchmarks.smk"
include: "workflow/rules/site.smk"


rule all:
    default_target: True
    input:
        rules.tables.input,
        rules.figures.input,
        rules.site.output,
        rules.collect.output,
    message:
        "All of it is there."
