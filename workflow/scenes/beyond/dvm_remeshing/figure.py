"""See `dvm_figures`."""

from __future__ import annotations

from scenes.lucchesi.dvm_figures import dvm_remeshing as figure

__all__ = ["figure"]
