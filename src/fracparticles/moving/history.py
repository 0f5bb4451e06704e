"""What happened to particles on their way: remeshings, and the strength that was left out or lost."""

from __future__ import annotations

from dataclasses import dataclass, field, fields

__all__ = ["History"]


@dataclass
class History:
    """What happened on the way.

    Attributes
    ----------
    remeshing_times, spacings_before, spacings_where : list of float
        For each remeshing the time, the largest spacing before it and the middle of that gap.
    particles : list of int
        The number of particles at the start and after each remeshing.
    total_initial, total_final : float
        Total strength given, and at the end.
    eliminated_count, eliminated_strength
        Particles left out because of the threshold, and their total strength.
    lost_strength : float
        Total strength of what remeshing put beyond its ends, less what it took from there.
    overtaking_steps : int
        Steps that changed the order of the particles: two that were in different places changed sides.
    largest_spacing : float
        The largest spacing after any step.
    velocity_evaluations : int
    """

    remeshing_times: list[float] = field(default_factory=list)
    spacings_before: list[float] = field(default_factory=list)
    spacings_where: list[float] = field(default_factory=list)
    particles: list[int] = field(default_factory=list)
    total_initial: float = 0.0
    total_final: float = 0.0
    eliminated_count: int = 0
    eliminated_strength: float = 0.0
    lost_strength: float = 0.0
    overtaking_steps: int = 0
    largest_spacing: float = 0.0
    velocity_evaluations: int = 0

    @property
    def remeshings(self) -> int:
        """How often the particles were redistributed."""
        return len(self.remeshing_times)

    def followed_by(self, later: History) -> History:
        """Return what happened in a run that went on: the later part starts from the particles of this one."""
        joined = {
            one.name: getattr(self, one.name) + getattr(later, one.name) for one in fields(self)
        }
        return History(
            **{
                **joined,
                "particles": self.particles + later.particles[1:],
                "total_initial": self.total_initial,
                "total_final": later.total_final,
                "largest_spacing": max(self.largest_spacing, later.largest_spacing),
            }
        )
