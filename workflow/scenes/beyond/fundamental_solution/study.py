"""See `fundamental`."""

from __future__ import annotations

from scenes.lucchesi.fundamental import fundamental_solution as study

__all__ = ["study"]
