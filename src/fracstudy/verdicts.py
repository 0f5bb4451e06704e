"""Verdicts, in the words of the ledger, and the verdict on a printed number."""

from __future__ import annotations

from enum import StrEnum
from fractions import Fraction

from fracparticles.errors import FracparticlesError

__all__ = ["LedgerError", "Status", "judge_value", "unit_of_last_digit"]


class LedgerError(FracparticlesError, ValueError):
    """Claims, criteria and findings do not fit together; the message names the claim and the reason."""


class Status(StrEnum):
    """A verdict, in the words of the ledger."""

    REPRODUCED = "reproduced"
    WITHIN_ROUNDING = "reproduced within the print's rounding"
    PART = "true in part"
    DEVIATES = "deviates"
    REFUTED = "refuted"
    MISPRINT = "misprint"
    NOT_TESTABLE = "not testable"

    @property
    def sign(self) -> str:
        """The sign that stands before the word in a table."""
        return dict(zip(Status, "✓≈◐≠✗✎?", strict=True))[self]

    @property
    def meaning(self) -> str:
        """The condition under which a number, a statement or a sentence gets it."""
        return {
            Status.REPRODUCED: "A number: ours rounds to all printed digits. A statement: it meets its criterion, in "
            "every case that it speaks of.",
            Status.WITHIN_ROUNDING: "A number: ours lies within one unit of the last printed digit, as where the "
            "print truncates.",
            Status.PART: "A statement: it meets its criterion in some cases and not in others. A sentence: some of "
            "what it says holds.",
            Status.DEVIATES: "A number: ours is more than one unit of the last printed digit away.",
            Status.REFUTED: "A statement: it meets its criterion in no case. A sentence: nothing that it says and that "
            "can be tested holds.",
            Status.MISPRINT: "A statement: as printed it fails its criterion, as it was plainly meant it meets it.",
            Status.NOT_TESTABLE: "The print leaves open what would have to be measured, or it cannot be measured.",
        }[self]

    @property
    def needs_reason(self) -> bool:
        """Whether the ledger must give a reason for it."""
        return self not in (Status.REPRODUCED, Status.WITHIN_ROUNDING)


def unit_of_last_digit(printed: str) -> Fraction:
    """One unit of the last printed digit: 1/100 for 8.83, 1/10000 for 1.11e-2."""
    mantissa, _, exponent = printed.partition("e")
    decimals = len(mantissa.partition(".")[2])
    return Fraction(10) ** (int(exponent or 0) - decimals)


def judge_value(printed: str, ours: float) -> Status:
    """Compare our number with the printed digits, in exact arithmetic.

    Let u be one unit of the last printed digit. A number is reproduced if ours differs by at most u/2, and so rounds to
    the printed digits. It is reproduced within the print's rounding up to u (a truncated print, 8.83 for 8.8354), and
    deviates beyond.
    """
    units = abs(Fraction(ours) - Fraction(printed)) / unit_of_last_digit(printed)
    if units <= Fraction(1, 2):
        return Status.REPRODUCED
    return Status.WITHIN_ROUNDING if units <= 1 else Status.DEVIATES
