"""One run: the case, its checks, the solver, the data set."""
