"""See `work_precision_figures`."""

from __future__ import annotations

from scenes.run_times.work_precision_figures import work_precision as figure

__all__ = ["figure"]
