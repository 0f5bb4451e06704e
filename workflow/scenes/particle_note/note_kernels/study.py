"""See `pse_note`."""

from __future__ import annotations

from scenes.particle_note.pse_note import note_kernels as study

__all__ = ["study"]
