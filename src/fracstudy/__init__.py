"""The study: claims, ledger, report, configuration, benchmarks and peers; what the scenes of the workflow share."""
