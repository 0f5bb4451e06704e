"""See `work_precision_shared`."""

from __future__ import annotations

from scenes.run_times.work_precision_shared import work_precision as study

__all__ = ["study"]
