"""See `marker_initial_figures`."""

from __future__ import annotations

from scenes.lewandowski.marker_initial_figures import marker_loading as figure

__all__ = ["figure"]
