"""The contenders: ours, the papers' way, and methods of the literature, each in its shortest fast form.

One small module each, with classes of `Contender`; they are found by their files.
"""

from fracstudy.race.contender import Contender
from fracstudy.race.discovery import found

__all__ = ["CONTENDERS"]

CONTENDERS: dict[str, type[Contender]] = found(__name__, Contender)
