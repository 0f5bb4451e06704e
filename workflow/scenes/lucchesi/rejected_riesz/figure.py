"""See `rejected_figures`."""

from __future__ import annotations

from scenes.lucchesi.rejected_figures import rejected_riesz as figure

__all__ = ["figure"]
