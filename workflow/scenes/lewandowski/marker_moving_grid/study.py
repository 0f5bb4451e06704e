"""See `marker_clusters`."""

from __future__ import annotations

from scenes.lewandowski.marker_clusters import marker_moving_grid as study

__all__ = ["study"]
