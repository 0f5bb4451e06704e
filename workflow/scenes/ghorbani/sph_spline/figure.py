"""See `sph_figures`."""

from __future__ import annotations

from scenes.ghorbani.sph_figures import sph_spline as figure

__all__ = ["figure"]
