"""What may be outside a bounded domain.

absorbing
    u = 0 outside: the restricted operator.
reflecting
    Nothing is outside: the exchange among the particles alone, the regional operator, which conserves.
given
    u = g outside.
"""

__all__ = ["EXTERIORS"]

EXTERIORS = ("absorbing", "reflecting", "given")
