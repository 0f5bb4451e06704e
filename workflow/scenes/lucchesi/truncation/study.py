"""See `truncation_shared`."""

from __future__ import annotations

from scenes.lucchesi.truncation_shared import truncation as study

__all__ = ["study"]
