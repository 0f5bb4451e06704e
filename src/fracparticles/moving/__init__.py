"""Particles that move: sums over scattered particles, Lagrangian runs, DVM, remeshing, random walks."""
