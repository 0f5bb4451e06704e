"""What the benchmarks of the scenes share: the clock, the problem, the contenders, the trials."""
