"""Error against run time: problems, contenders, and a clock. A new one of either is a new file, listed nowhere."""
