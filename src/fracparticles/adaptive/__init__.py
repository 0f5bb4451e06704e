"""Particles of unequal volume on the line: where they are put, what they exchange, how they follow a solution."""
