"""See `pse_note_figures`."""

from __future__ import annotations

from scenes.particle_note.pse_note_figures import note_conservation as figure

__all__ = ["figure"]
