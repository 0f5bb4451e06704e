"""Sums and linear operators on a lattice, and the continuation beyond its ends."""
