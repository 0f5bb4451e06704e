"""See `run_times`."""

from __future__ import annotations

from scenes.run_times.run_times import scattered_sums as study

__all__ = ["study"]
