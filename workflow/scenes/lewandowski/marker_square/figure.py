"""See `marker_diffusion_figures`."""

from __future__ import annotations

from scenes.lewandowski.marker_diffusion_figures import marker_square as figure

__all__ = ["figure"]
