"""See `spacing_shared`."""

from __future__ import annotations

from scenes.lucchesi.spacing_shared import spacing as study

__all__ = ["study"]
