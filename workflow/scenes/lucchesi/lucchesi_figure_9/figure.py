"""See `two_dimensional_errors_figures`."""

from __future__ import annotations

from scenes.lucchesi.two_dimensional_errors_figures import planar_errors as figure

__all__ = ["figure"]
