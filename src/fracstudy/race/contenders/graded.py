"""Ours: one Green step of the field between graded particles, close together in the middle."""

from __future__ import annotations

import numpy as np

from fracparticles.graded.field import INTERPOLATED, graded_step
from fracparticles.graded.particles import graded_particles
from fracstudy.race.contender import ENOUGH, Contender, Ready, Trials
from fracstudy.race.problem import Problem

_COUNTS = (25, 35, 49, 69, 97, 137, 193, 273)
_MANY = 49  # particles from which set-ups take long: the worse half of the scales is then left out
_REACHES = (200.0, 5000.0)  # half-widths
_SCALES = (0.01, 0.1, 1.0, 3.0)  # lengths L of the grading


class Graded(Contender):
    """`fracparticles.green_step_of_field`."""

    name, label = "graded", "graded particles"
    reference = "this library"
    group, place = "ours", 10
    colour, marker = "#56B4E9", "h"

    def trials(self, problem: Problem) -> Trials:
        """Yield numbers of particles, half-widths and scales of the grading."""
        scales = list(_SCALES)
        for reach in _REACHES:
            for count in _COUNTS:
                errors = []
                for scale in scales:
                    error = yield {"variant": "", "count": count, "reach": reach, "scale": scale}
                    errors.append(np.inf if error is None else error)
                if min(errors) < ENOUGH:
                    break
                if count >= _MANY and min(errors) < np.inf:
                    better = sorted(zip(errors, scales, strict=True))
                    scales = [scale for _, scale in better[: max(2, len(better) // 2)]]

    def prepare(
        self, problem: Problem, variant: str, count: int, reach: float, scale: float
    ) -> Ready:
        """Return the matrix of the step."""
        x, volumes = graded_particles(count, reach, scale)
        step = graded_step(count, reach, scale, problem.alpha, problem.time, INTERPOLATED).T

        return Ready((x,), volumes, lambda u0: u0 @ step, batched=True)
