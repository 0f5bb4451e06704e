"""See `work_precision_shared`."""

from __future__ import annotations

from scenes.run_times.work_precision_shared import time_to_accuracy as study

__all__ = ["study"]
