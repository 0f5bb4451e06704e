"""See `which_method_shared`."""

from __future__ import annotations

from scenes.run_times.which_method_shared import which_method as study

__all__ = ["study"]
