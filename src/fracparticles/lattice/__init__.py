"""Sums and linear operators on a lattice, and what lies outside of it."""
