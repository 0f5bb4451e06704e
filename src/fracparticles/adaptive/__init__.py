"""Particles of unequal volume on the line: how they are placed, what they exchange, and how they follow a solution."""
