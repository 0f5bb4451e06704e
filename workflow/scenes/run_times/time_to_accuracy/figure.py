"""See `work_precision_figures`."""

from __future__ import annotations

from scenes.run_times.work_precision_figures import time_to_accuracy as figure

__all__ = ["figure"]
