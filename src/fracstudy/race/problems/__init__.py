"""The problems: u_t = -(-Laplacian)^(alpha/2) u on the whole space from given data, after a time of 1.

One small module each, with a class of `Problem`; it is found by its file.
"""

from fracparticles.schemes.discovery import named_classes
from fracstudy.race.problem import Problem

__all__ = ["PROBLEMS"]

PROBLEMS: dict[str, type[Problem]] = named_classes(__name__, Problem)
