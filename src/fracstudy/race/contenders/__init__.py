"""The contenders: ours, the papers' way, and methods of the literature, each in its shortest fast form.

One small module each, with classes of `Contender`; they are found by their files.
"""

from fracparticles.schemes.discovery import named_classes
from fracstudy.race.contender import Contender

__all__ = ["CONTENDERS"]

CONTENDERS: dict[str, type[Contender]] = named_classes(__name__, Contender)
