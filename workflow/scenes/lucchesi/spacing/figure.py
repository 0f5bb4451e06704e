"""See `errors_figures`."""

from __future__ import annotations

from scenes.lucchesi.errors_figures import spacing as figure

__all__ = ["figure"]
