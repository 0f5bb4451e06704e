"""See `marker_diffusion_figures`."""

from __future__ import annotations

from scenes.lewandowski.marker_diffusion_figures import marker_error_norm as figure

__all__ = ["figure"]
