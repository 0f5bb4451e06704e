# Run times. They differ from machine to machine and are no part of the target `all`.
BENCHMARK = dict(STUDY.benchmark)
SUMS_BENCHMARK = {name: BENCHMARK.pop(name, {}) for name in ("boxes", "scattered")}


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
        **BENCHMARK,
    script:
        "../scripts/benchmark_reference.py"


rule sums_benchmark:
    input:
        code=[*CORE, PACKAGE / "benchmark.py", PACKAGE / "benchmark_sums.py"],
        compiled=COMPILED,
    output:
        boxes_data=RESULTS / "benchmarks/boxes.nc",
        boxes_csv=RESULTS / "benchmarks/boxes.csv",
        boxes_md=RESULTS / "benchmarks/boxes.md",
        scattered_data=RESULTS / "benchmarks/scattered.nc",
        scattered_csv=RESULTS / "benchmarks/scattered.csv",
        scattered_md=RESULTS / "benchmarks/scattered.md",
    log:
        RESULTS / "logs/sums_benchmark.log",
    threads: 1024
    params:
        **SUMS_BENCHMARK,
    script:
        "../scripts/benchmark_sums.py"


rule bench:
    input:
        rules.reference_benchmark.output,
        rules.sums_benchmark.output,
