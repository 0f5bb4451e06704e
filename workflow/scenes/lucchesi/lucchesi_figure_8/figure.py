"""See `two_dimensions_figures`."""

from __future__ import annotations

from scenes.lucchesi.two_dimensions_figures import planar_profiles as figure

__all__ = ["figure"]
