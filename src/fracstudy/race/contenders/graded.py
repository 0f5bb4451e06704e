"""Ours: one Green step of the field between graded particles, close together in the middle."""

from __future__ import annotations

from itertools import product

from fracparticles.graded.field import INTERPOLATED, graded_step
from fracparticles.graded.particles import graded_particles
from fracstudy.race.contender import Contender, Ready, Trials
from fracstudy.race.problem import Problem

_COUNTS = (25, 35, 49, 69, 97, 137, 193, 273)
_REACHES = (200.0, 5000.0)
_SCALES = (0.01, 0.1, 1.0, 3.0)


class Graded(Contender):
    """`fracparticles.green_step_of_field`."""

    name, label = "graded", "graded particles"
    reference = "this library"
    group, place = "ours", 10
    colour, marker = "#56B4E9", "h"

    def trials(self, problem: Problem) -> Trials:
        """Yield numbers of particles, half-widths and scales of the grading."""
        for count, reach, scale in product(_COUNTS, _REACHES, _SCALES):
            yield {"variant": "", "count": count, "reach": reach, "scale": scale}

    def prepare(
        self, problem: Problem, variant: str, count: int, reach: float, scale: float
    ) -> Ready:
        """Return the matrix of the step."""
        x, volumes = graded_particles(count, reach, scale)
        step = graded_step(count, reach, scale, problem.alpha, problem.time, INTERPOLATED).T

        return Ready((x,), volumes, lambda u0: u0 @ step, batched=True)
