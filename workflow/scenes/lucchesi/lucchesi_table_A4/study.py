"""See `fundamental`."""

from __future__ import annotations

from scenes.lucchesi.fundamental import mean_radius as study

__all__ = ["study"]
