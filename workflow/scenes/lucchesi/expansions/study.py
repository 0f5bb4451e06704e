"""See `fundamental`."""

from __future__ import annotations

from scenes.lucchesi.fundamental import expansions as study

__all__ = ["study"]
