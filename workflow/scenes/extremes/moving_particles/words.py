"""What probes of moving particles have in common: growth against its prediction, errors that must be spoken of."""

from collections.abc import Callable
from typing import Any

import numpy as np

from fracstudy.panels import Panels
from fracstudy.probe import overheard, quiet


def missed(growth: Callable[..., tuple[float, float]], *arguments: Any) -> tuple[float, str]:
    """Return how far the growth of a wave in a step is from its prediction."""
    found, predicted = growth(*arguments)
    return abs(found - predicted), f"{found:.3f}, predicted {predicted:.3f}"


def add_error(panels: Panels, series: str, x: float, run: Callable[[], float]) -> None:
    """Add the error of a run, not a number where it is refused, and whether it spoke."""
    try:
        with quiet(), overheard() as words:
            error = run()
    except ArithmeticError:
        error = np.nan
    panels.add("error", series, x, error, spoke=bool(words))
