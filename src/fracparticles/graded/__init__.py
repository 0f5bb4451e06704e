"""Particles of unequal volume: graded like sinh, and the Green step on them and of the field between them."""
