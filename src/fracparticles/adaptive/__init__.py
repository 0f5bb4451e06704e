"""Particles of unequal volume on the line: maps that place them, an exchange of high order, placing again."""
