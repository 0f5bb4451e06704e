"""See `run_times`."""

from __future__ import annotations

from scenes.run_times.run_times import reference_times as study

__all__ = ["study"]
