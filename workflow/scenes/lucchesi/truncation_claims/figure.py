"""See `errors_figures`."""

from __future__ import annotations

from scenes.lucchesi.errors_figures import truncation_overview as figure

__all__ = ["figure"]
