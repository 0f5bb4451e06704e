"""See `fundamental_figures`."""

from __future__ import annotations

from scenes.lucchesi.fundamental_figures import expansions as figure

__all__ = ["figure"]
