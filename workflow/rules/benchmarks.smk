# Run times. They differ from machine to machine and are no part of the target `all`.


rule reference_benchmark:
    input:
        code=[*CORE, PACKAGE / "benchmark.py"],
        compiled=COMPILED,
    output:
        data=RESULTS / "benchmarks/reference.nc",
        csv=RESULTS / "benchmarks/reference.csv",
        md=RESULTS / "benchmarks/reference.md",
    log:
        RESULTS / "logs/reference_benchmark.log",
    # More than there are, which Snakemake scales down to all: nothing else runs while the clock does.
    threads: 1024
    params:
        **STUDY.benchmark,
    script:
        "../scripts/benchmark_reference.py"


rule bench:
    input:
        rules.reference_benchmark.output,
