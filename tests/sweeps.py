"""Sweeps: the tests take the few cases that show a claim, the profile `thorough` of hypothesis takes all."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable
from itertools import combinations, product
from typing import Any

from hypothesis import settings


def thorough() -> bool:
    return settings.get_current_profile_name() == "thorough"


def few(values: Iterable[Any], count: int = 2) -> list[Any]:
    """So many of them from the first to the last, at even distances, or all."""
    every = list(values)
    if thorough() or len(every) <= count:
        return every
    return [every[round(k * (len(every) - 1) / max(count - 1, 1))] for k in range(count)]


def covering(*axes: Iterable[Any], together: int = 1) -> list[tuple[Any, ...]]:
    """Of the product of the axes so few that any values of `together` axes meet in one of them, or all."""
    axes = tuple(map(list, axes))
    choices = list(product(*(range(len(axis)) for axis in axes)))
    if not thorough():
        choices = _fewest(choices, together)
    return [tuple(axis[k] for axis, k in zip(axes, choice, strict=True)) for choice in choices]


def _fewest(choices: list[tuple[int, ...]], together: int) -> list[tuple[int, ...]]:
    """Take again and again what has the most of what no other has yet, of such the least used values."""
    met = {choice: set(combinations(enumerate(choice), together)) for choice in choices}
    missing, used, taken = set().union(*met.values()), Counter(), []
    while missing:
        taken.append(
            max(choices, key=lambda c: (len(met[c] & missing), -sum(used[v] for v in enumerate(c))))
        )
        missing -= met[taken[-1]]
        used.update(enumerate(taken[-1]))
    return taken


def at_once(values: Iterable[Any]) -> Callable[[Callable[..., None]], Callable[[], None]]:
    """One test over all of them, each a tuple of arguments or the only one: what fails names those it fails for."""
    every = list(values)

    def whole(test: Callable[..., None]) -> Callable[[], None]:
        def over_all() -> None:
            for value in every:
                try:
                    test(*value) if isinstance(value, tuple) else test(value)
                except BaseException as error:
                    error.add_note(f"for {value}")
                    raise

        over_all.__name__, over_all.__doc__ = test.__name__, test.__doc__
        return over_all

    return whole
