"""The marker method for diffusion and other conservation equations, in one dimension.

Lewandowski, "Marker method for the solution of nonlinear diffusion equations"; its equations are cited by their
numbers. `shapes` has the shape functions S1 to S8, `profiles` the initial profiles with their exact solutions,
`loading` the initial markers, `solver` their motion, and `stability` the clusters and time steps that follow from the
Fourier transform of a shape function. `growth`, `clusters` and `accuracy` measure these, and the error law (19), in
runs.
"""

from __future__ import annotations

from fracparticles.markers.loading import equal_weight, random, uniform
from fracparticles.markers.profiles import Gaussian, Ramp, Square
from fracparticles.markers.shapes import SHAPES, Shape, shape_function
from fracparticles.markers.solver import MarkerRun, MarkerVelocity, diffusion, run

__all__ = [
    "SHAPES",
    "Gaussian",
    "MarkerRun",
    "MarkerVelocity",
    "Ramp",
    "Shape",
    "Square",
    "diffusion",
    "equal_weight",
    "random",
    "run",
    "shape_function",
    "uniform",
]
