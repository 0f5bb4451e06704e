"""See `marker_diffusion_figures`."""

from __future__ import annotations

from scenes.lewandowski.marker_diffusion_figures import marker_fixed_grid as figure

__all__ = ["figure"]
