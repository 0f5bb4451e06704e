"""See `marker_clusters`."""

from __future__ import annotations

from scenes.lewandowski.marker_clusters import marker_error_norm as study

__all__ = ["study"]
