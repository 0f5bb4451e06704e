"""The front of the companions: whatever their public functions and classes are given, `InvalidInput` is what comes.

SPH, the PSE note, markers, the random walk, remeshing, Lagrangian particles and scattered sums. Each entry of `CALLS`
is a call that works and the kind of every argument; each argument in turn is replaced by what its kind is not.
"""

from __future__ import annotations

import importlib
import warnings
from fractions import Fraction

import numpy as np
import pytest

from fracparticles.errors import AccuracyWarning, InvalidInput
from fracparticles.markers import (
    burgers,
    fourier,
    kdv,
    loading,
    nonlinear,
    plane,
    profiles,
    solver,
    source,
    stability,
)
from fracparticles.markers import shapes as marker_shapes
from fracparticles.moving import lagrangian, random_walk, remeshing, scattered
from fracparticles.pse import approximation, construction, exchange, moments
from fracparticles.pse import shapes as kernels
from fracparticles.sph import (
    closed_forms,
    cubic_spline,
    derivatives,
    integrals,
    norms,
    one_f_two,
    operators,
)
from fracparticles.sph.particles import ParticleLine
from sweeps import at_once

MODULES = {
    "lagrangian": lagrangian,
    "random_walk": random_walk,
    "remeshing": remeshing,
    "scattered": scattered,
    **{
        m.__name__.removeprefix("fracparticles."): m
        for m in (
            burgers, fourier, kdv, loading, nonlinear, plane, profiles, marker_shapes, solver, source,
            stability, approximation, construction, exchange, moments, kernels, closed_forms,
            cubic_spline, derivatives, integrals, norms, one_f_two, operators,
            importlib.import_module("fracparticles.sph.particles"),
        )
    },
}  # fmt: skip

# What no argument of any kind is.
NEVER = ["text", object(), {"a": 1}]
NUMBER = [*NEVER, None, np.nan, np.inf, -np.inf, 1j, [1.0, 2.0], True, 10**400]
RAGGED = [[1.0, 2.0], [3.0]]
NO_NUMBERS = [
    *NEVER, None, np.nan, [1.0, np.nan], ["a", "b"], [1.0, None], RAGGED, [True, False],
    np.ma.masked_array([1.0, 2.0], mask=[0, 1]), np.array(["2026-01-01"], dtype="M8[D]"), 10**400,
]  # fmt: skip
COMPLEX, INFINITE = [1j, np.array([1.0, 1j])], [np.inf, [1.0, np.inf]]
FIELD = [*NO_NUMBERS, *COMPLEX, *INFINITE]
NO_LINE = [[], 1.0, np.ones((2, 2)), np.ones(97)]
BAD = {
    "number": NUMBER,
    "positive": [*NUMBER, 0.0, -1.0, 1e-300, Fraction(1, 10**400)],
    "not negative": [*NUMBER, -1.0],
    "whole": [*NUMBER, 1.5, 2.0, -1],
    "count": [*NUMBER, 1.5, 2.0, -1, 0, np.int64(-3)],
    "field": FIELD,  # an array of any shape, or a number
    "infinite field": [*NO_NUMBERS, *COMPLEX],
    "line": [*FIELD, *NO_LINE],  # one number for each of the others
    "points": [*FIELD, 1.0, np.ones((2, 2))],  # in one dimension; may be empty
    "particles": [*FIELD, [], 1.0, np.ones((2, 2))],
    "rising": [*FIELD, [], 1.0, np.ones((2, 2)), [1.0, 0.0]],
    "complex line": [*NO_NUMBERS, *INFINITE, *NO_LINE, [1j, np.nan]],
    "name": ["text", "", None, 1, ["M4'"], np.nan, True],
    "flag": ["text", None, 1, 0.0, [True]],
    "function": ["text", None, 1.0, [np.sin]],
    "values": ["text", None, 1.0, lambda x: 1.0, lambda x: "text", lambda x: x * np.nan, lambda x: None,
               lambda x: x * 1j, lambda x: float(x), lambda x: x[:1]],
    "object": ["text", None, 1.0, [1.0], object()],
    "pair": ["text", None, 1.0, (1.0,), (0.0, 1.0, 2.0), [np.nan, 1.0], ("a", "b"), (1j, 2.0), (2.0, 1.0)],
    "counts": ["text", None, 3, (1,), (0, 2), (1.5, 2), (True, 2), (2, np.nan), (-1, 2), (2**20, 2**20)],
}  # fmt: skip
OPTIONAL = {
    "optional number": "positive",
    "optional points": "points",
    "optional function": "function",
}
for name, kind in OPTIONAL.items():
    BAD[name] = [value for value in BAD[kind] if value is not None]

X = np.linspace(0.0, 1.0, 11)
Z = X[3:6]
LINE = ParticleLine(0.0, 1.0, 11)
ALL = np.sin(LINE.x_all)
SHAPE = marker_shapes.SHAPES["S4"]
VELOCITY = solver.MarkerVelocity(SHAPE, 0.3)
KERNEL = kernels.GAUSSIAN_20
GAUSSIAN = scattered.ScatteredKernel(lambda r: np.exp(-r * r), 12.0, 6.5)
RANDOM = np.random.default_rng(1)
CUBIC = closed_forms.ShiftedPower(-1.0, 3)
POINT, SOLITON = burgers.PointSource(0.1, 1.0), kdv.Soliton(1.0, 0.1)
PROBLEM = nonlinear.NonlinearDiffusion()
LINES = nonlinear.Lines(PROBLEM, 3.0, 20, 2.0)
BLOBS = plane.TwoBlobs(1.0)
SOURCE = source.GaussianSource(1.0)
EXCHANGE = exchange.StrengthExchange(X, 0.1, 0.2, KERNEL)
ONES = np.ones(11)


def still(x, strength):
    return np.zeros_like(x)


PARTICLES = {
    "z": (Z, "points"),
    "x": (X, "rising"),
    "volumes": (0.1 * ONES, "field"),
    "h": (0.11, "positive"),
}
OPERATOR = {
    "line": (LINE, "object"), "f": (ALL, "line"), "order": (0.5, "field"), "side": ("left", "name"),
    "method": ("standard", "name"),
}  # fmt: skip
SUM = {"x": (X, "points"), "q": (ONES, "line"), "z": (None, "optional points")}
OF_TIME = {"x": (X, "field"), "t": (0.5, "not negative")}
FULL = {"x": (X, "points"), "particles": (X, "particles"), "values": (X, "complex line"),
        "volumes": (0.1, "field"), "epsilon": (0.2, "positive"), "kernel": (KERNEL, "object")}  # fmt: skip

CALLS = {
    # sph
    "spline": (cubic_spline.spline, {"x": (X, "infinite field"), "h": (0.1, "positive")}),
    "spline_gradient": (cubic_spline.spline_gradient, {"x": (X, "infinite field"), "h": (0.1, "positive")}),
    "spline_integral": (cubic_spline.spline_integral, {"x": (X, "infinite field"), "h": (0.1, "positive")}),
    "correction": (derivatives.correction, PARTICLES),
    "gradient": (derivatives.gradient, PARTICLES | {"f": (X, "complex line"), "corrected": (True, "flag")}),
    "second_derivative": (
        derivatives.second_derivative,
        PARTICLES | {"f_z": (Z, "complex line"), "f": (X, "complex line"), "eta": (1e-3, "not negative*")},
    ),
    "power_integral": (
        integrals.power_integral,
        {"line": (LINE, "object"), "f": (X, "complex line"), "z": (X, "points"), "power": (0.5 * ONES, "field"),
         "method": ("halved", "name")},
    ),
    "power_sum": (
        integrals.power_sum,
        {"z": (X, "points"), "x": (X, "particles"), "strengths": (X, "complex line"), "power": (0.5, "field"),
         "h": (0.1, "positive")},
    ),
    "relative_l2": (norms.relative_l2, {"exact": (X, "line"), "ours": (X, "complex line")}),
    "r2_score": (norms.r2_score, {"exact": (X, "line"), "ours": (X, "complex line")}),
    "one_f_two": (one_f_two.one_f_two, {"b": (1.5, "field"), "y": (X, "field")}),
    "rl_integral": (operators.rl_integral, OPERATOR),
    "rl_derivative": (operators.rl_derivative, OPERATOR),
    "caputo_derivative": (operators.caputo_derivative, OPERATOR),
    "singular_integral": (operators.singular_integral, {k: v for k, v in OPERATOR.items() if k != "side"}),
    "ParticleLine": (
        ParticleLine,
        {"a": (0.0, "number"), "b": (1.0, "positive*"), "count": (10, "count"), "smoothing_ratio": (1.1, "positive")},
    ),
    "ParticleLine.field": (lambda values: LINE.field("f", values), {"values": (ALL, "line")}),
    "Sine": (closed_forms.Sine, {"beta": (1.0, "positive")}),
    "Cosine": (closed_forms.Cosine, {"beta": (1.0, "positive")}),
    "Exponential": (closed_forms.Exponential, {"beta": (1.0, "number")}),
    "ShiftedPower": (closed_forms.ShiftedPower, {"beta": (-1.0, "number"), "n": (3, "count")}),
    "Function.value": (CUBIC.value, {"x": (X, "field")}),
    "Function.caputo": (CUBIC.caputo, {"x": (X, "field"), "alpha": (0.5, "field")}),
    "Function.rl": (CUBIC.rl, {"x": (X, "field"), "alpha": (0.5, "field")}),
    "Function.mirrored": (CUBIC.mirrored, {"b": (1.5, "number")}),
    "ShiftedPower.rl_as_printed": (CUBIC.rl_as_printed, {"x": (X, "field"), "alpha": (0.5, "field")}),
    # pse
    "lattice": (approximation.lattice, {"low": (0.0, "number"), "high": (1.0, "number"), "h": (0.1, "positive")}),
    "reconstruct": (approximation.reconstruct, FULL),
    "derivative": (approximation.derivative, FULL | {"at": (X, "complex line"), "order": (2, "count")}),
    "regularised": (
        approximation.regularised,
        {"f": (np.sin, "values"), "x": (X, "points"), "epsilon": (0.1, "positive"), "kernel": (KERNEL, "object"),
         "order": (2, "whole")},
    ),
    "required_moments": (construction.required_moments, {"derivative": (2, "whole"), "accuracy": (2, "count")}),
    "construct": (
        construction.construct,
        {"derivative": (2, "whole"), "accuracy": (2, "count"), "overlap": (1.0, "optional number")},
    ),
    "construct_laplacian": (construction.construct_laplacian, {"accuracy": (2, "count"), "dim": (2, "count")}),
    "construct_stencil": (construction.construct_stencil, {"derivative": (2, "count"), "accuracy": (2, "count")}),
    "taylor_constant": (
        construction.taylor_constant,
        {"kernel": (KERNEL, "object"), "derivative": (2, "whole"), "accuracy": (2, "count")},
    ),
    "solve_exactly": (
        construction.solve_exactly,
        {"matrix": ([[1, 2], [3, 4]], "object"), "right": ([1, 2], "object")},
    ),
    "StrengthExchange": (
        exchange.StrengthExchange,
        {"x": (X, "field*"), "volumes": (0.1, "field"), "epsilon": (0.2, "positive"), "kernel": (KERNEL, "object"),
         "diffusivity": (1.0, "positive")},
    ),
    "StrengthExchange.apply": (EXCHANGE.apply, {"u": (X, "complex line*")}),
    "cell_volumes": (exchange.cell_volumes, {"x": (X, "rising")}),
    "absolute_moment": (moments.absolute_moment, {"kernel": (KERNEL, "object"), "k": (1, "whole")}),
    "moment": (moments.moment, {"kernel": (KERNEL, "object"), "k": (1, "whole")}),
    "nodes_and_weights": (moments.nodes_and_weights, {"kernel": (KERNEL, "object")}),
    "gaussian_moment": (moments.gaussian_moment, {"k": (2, "whole"), "dim": (1, "count")}),
    "lattice_moment": (
        moments.lattice_moment,
        {"kernel": (KERNEL, "object"), "k": (2, "whole"), "overlap": (1.0, "field"), "offset": (0.5, "number")},
    ),
    "GaussianKernel": (
        kernels.GaussianKernel,
        {"coefficients": ((1.0,), "field*"), "parity": (0, "whole"), "dim": (1, "count"), "condition": (1.0, "number")},
    ),
    "SplineKernel": (kernels.SplineKernel, {"degree": (3, "count")}),
    "Stencil": (kernels.Stencil, {"values": ((1, 0, 1), "field*"), "condition": (1.0, "number")}),
    "GAUSSIAN_20": (KERNEL, {"z": (X, "infinite field")}),
    "TENT_27": (kernels.TENT_27, {"z": (X, "infinite field")}),
    "SplineKernel.call": (kernels.SplineKernel(20), {"z": (X, "infinite field")}),
    "Stencil.call": (construction.construct_stencil(2, 2), {"z": (np.arange(3.0), "infinite field")}),
    "kernel_of": (kernels.kernel_of, {"dim": (1, "count"), "kernel": (KERNEL, "object")}),
    # markers
    "burgers": (burgers.burgers, {"mu": (1.0, "positive")}),
    "PointSource": (burgers.PointSource, {"mu": (1.0, "positive"), "total": (1.0, "positive")}),
    "PointSource.value": (POINT.value, {"x": (X, "field"), "t": (1.0, "positive")}),
    "PointSource.cumulative": (POINT.cumulative, {"x": (X, "field"), "t": (1.0, "positive")}),
    "PointSource.quantile": (POINT.quantile, {"g": (Z, "part"), "t": (1.0, "positive")}),
    "FourierMarkerVelocity": (
        fourier.FourierMarkerVelocity,
        {"epsilon": (1.0, "positive"), "flux": (solver.diffusion, "function"), "derivatives": (1, "whole")},
    ),
    "FourierMarkerVelocity.fields": (
        fourier.FourierMarkerVelocity(1.0).fields, {"x": (X, "points"), "weights": (ONES, "line")}
    ),
    "Soliton": (kdv.Soliton, {"c": (1.0, "positive"), "background": (0.0, "not negative")}),
    "Soliton.value": (SOLITON.value, {"x": (X, "field"), "t": (1.0, "number")}),
    "Soliton.velocity": (SOLITON.velocity, {"f": (ONES, "field")}),
    "uniform": (loading.uniform, {"f": (np.sin, "values"), "ends": ((0.0, 1.0), "pair"), "count": (5, "count")}),
    "equal_weight": (loading.equal_weight, {"profile": (profiles.Square(), "object"), "count": (5, "count")}),
    "random": (
        loading.random,
        {"profile": (profiles.Square(), "object"), "count": (5, "count"), "generator": (RANDOM, "object")},
    ),
    "NonlinearDiffusion": (
        nonlinear.NonlinearDiffusion,
        {"d0": (1.0, "positive"), "alpha": (1.0, "positive"), "x0": (1.0, "positive")},
    ),
    "NonlinearDiffusion.diffusivity": (PROBLEM.diffusivity, {"f": (X, "field")}),
    "NonlinearDiffusion.potential": (PROBLEM.potential, {"f": (X, "field")}),
    "NonlinearDiffusion.steady": (PROBLEM.steady, {"x": (X, "field"), "derivative": (0, "whole")}),
    "NonlinearDiffusion.source": (PROBLEM.source, {"x": (X, "field")}),
    "NonlinearDiffusion.cumulative_source": (PROBLEM.cumulative_source, {"x": (X, "field")}),
    "NonlinearDiffusion.step_limit": (PROBLEM.step_limit, {"epsilon": (1.0, "positive"), "eta": (1.0, "positive*")}),
    "Lines": (
        nonlinear.Lines,
        {"problem": (PROBLEM, "object"), "half_width": (3.0, "positive"), "cells": (20, "count"),
         "within": (2.0, "positive*")},
    ),
    "Lines.solve": (LINES.solve, {"f": (np.full(20, 0.5), "line"), "times": ([0.0, 1e-3], "rising")}),
    "Lines.positivity_lost": (
        LINES.positivity_lost, {"f": (np.full(20, 0.5), "line"), "until": (1e-3, "positive")}
    ),
    "Lines.rate": (LINES.rate, {"t": (0.0, "any"), "f": (np.full(20, 0.5), "line*")}),
    "Lines.jacobian": (LINES.jacobian, {"t": (0.0, "any"), "f": (np.full(20, 0.5), "line*")}),
    "TwoBlobs": (plane.TwoBlobs, {"a": (1.0, "not negative")}),
    "TwoBlobs.value": (BLOBS.value, {"x": (X, "field"), "y": (X, "field")}),
    "TwoBlobs.marginal": (BLOBS.marginal, {"x": (X, "field")}),
    "TwoBlobs.product": (BLOBS.product, {"x": (X, "field"), "y": (X, "field")}),
    "TwoBlobs.quantile": (BLOBS.quantile, {"xi": (Z, "part"), "right": (0.5, "field")}),
    "TwoBlobs.right": (BLOBS.right, {"x": (X, "field")}),
    "decoupled": (
        plane.decoupled,
        {"quantile": (BLOBS.quantile, "values"), "total": (1.0, "positive"), "counts": ((2, 3), "counts")},
    ),
    "weighted": (plane.weighted, {"density": (BLOBS, "object"), "counts": ((2, 3), "counts")}),
    "sequential": (plane.sequential, {"density": (BLOBS, "object"), "counts": ((2, 3), "counts")}),
    "markers.plane.reconstruct": (
        plane.reconstruct,
        {"shape": (SHAPE, "object"), "epsilon": (1.0, "positive"), "markers": ((X, X, X), "object"),
         "x": (X, "particles"), "y": (X, "particles")},
    ),
    **{
        f"{type(profile).__name__}.{method}": (getattr(profile, method), arguments)
        for profile in (profiles.Square(), profiles.Gaussian())
        for method, arguments in {
            "value": OF_TIME, "cumulative": OF_TIME, "quantile": {"g": (Z, "part"), "t": (0.5, "not negative")},
        }.items()
    },
    "Square.slope": (profiles.Square().slope, {"x": (X, "field"), "t": (0.5, "positive")}),
    "Ramp": (profiles.Ramp, {"end": (1.0, "positive")}),
    "Ramp.value": (profiles.Ramp(1.0).value, {"x": (X, "field")}),
    "Ramp.quantile": (profiles.Ramp(2.0).quantile, {"g": (Z * 0.5, "part")}),
    "inside": (profiles.inside, {"g": (Z, "part"), "total": (1.0, "any")}),
    "shape_function": (marker_shapes.shape_function, {"name": ("S1", "name")}),
    "Shape.call": (SHAPE, {"x": (X, "infinite field"), "derivative": (0, "whole")}),
    "Shape.kernel": (SHAPE.kernel, {"derivative": (0, "whole")}),
    "Shape.transform": (SHAPE.transform, {"k": (X, "field")}),
    "MarkerVelocity": (
        solver.MarkerVelocity,
        {"shape": (SHAPE, "object"), "epsilon": (0.1, "positive"), "flux": (solver.diffusion, "function"),
         "derivatives": (1, "whole"), "period": (1.0, "optional number")},
    ),
    "MarkerVelocity.fields": (VELOCITY.fields, {"x": (X, "points"), "weights": (ONES, "line")}),
    "MarkerVelocity.call": (VELOCITY, {"x": (X, "particles"), "weights": (ONES, "line")}),
    "periodic": (
        solver.MarkerVelocity(SHAPE, 1.0, period=3.0).fields,
        {"x": (X, "particles"), "weights": (ONES, "line"), "z": (X, "optional points")},
    ),
    "markers.run": (
        solver.run,
        {"x": (X, "particles"), "weights": (ONES, "line"), "velocity": (VELOCITY, "object"), "dt": (0.01, "positive"),
         "steps": (1, "count"), "start": (0.0, "number"), "observe": (None, "optional function")},
    ),
    "source_flux": (source.source_flux, {"cumulative": (np.sin, "function")}),
    "advance_weights": (
        source.advance_weights,
        {"x": (X, "particles"), "weights": (ONES, "line"), "velocity": (VELOCITY, "object"),
         "source": (lambda x: np.exp(-100.0 * (x - 0.5) ** 2), "function"), "dt": (0.01, "positive"),
         "steps": (1, "count"), "stages": (2, "count")},
    ),
    "GaussianSource": (source.GaussianSource, {"q": (1.0, "number"), "derivative": (0, "whole")}),
    "GaussianSource.rate": (SOURCE.rate, {"x": (X, "field")}),
    "GaussianSource.cumulative": (SOURCE.cumulative, {"x": (X, "field")}),
    "GaussianSource.solution": (SOURCE.solution, OF_TIME),
    "extremes": (stability.extremes, {"shape": (SHAPE, "object"), "largest": (30.0, "positive")}),
    "lattice_rate": (
        stability.lattice_rate, {"shape": (SHAPE, "object"), "k": (X, "field"), "spacing": (0.1, "positive")}
    ),
    "rate": (stability.rate, {"shape": (SHAPE, "object"), "k": (X, "field")}),
    # the others
    "cell_counts": (
        random_walk.cell_counts,
        {"x": (X, "particles"), "half_width": (1.0, "positive"), "cells": (4, "count"), "ensembles": (2, "count")},
    ),
    "cell_masses": (
        random_walk.cell_masses, {"edges": (X, "infinite rising"), "t": (1.0, "positive*"), "alpha": (1.5, "number")}
    ),
    "distribution": (
        random_walk.distribution, {"x": (X, "infinite field"), "t": (1.0, "positive*"), "alpha": (1.5, "number")}
    ),
    "expected_deviation": (random_walk.expected_deviation, {"masses": (X, "field"), "walkers": (5, "count")}),
    "kolmogorov_smirnov": (
        random_walk.kolmogorov_smirnov, {"x": (X, "particles"), "t": (1.0, "positive*"), "alpha": (1.5, "number")}
    ),
    "stable_variates": (
        random_walk.stable_variates,
        {"alpha": (1.5, "number"), "size": (3, "count"), "generator": (RANDOM, "object")},
    ),
    "walk": (
        random_walk.walk,
        {"x": (X, "particles"), "alpha": (1.5, "number"), "time": (1.0, "positive"), "generator": (RANDOM, "object"),
         "steps": (1, "count"), "diffusivity": (1.0, "positive")},
    ),
    "eliminate": (
        remeshing.eliminate, {"x": (X, "particles"), "strength": (ONES, "line"), "threshold": (0.0, "not negative")}
    ),
    "interpolation_function": (
        remeshing.interpolation_function, {"name": ("M4'", "name"), "r": (X, "infinite field")}
    ),
    "remesh": (
        remeshing.remesh,
        {"x": (X, "particles"), "strength": (ONES, "line"), "spacing": (0.1, "positive"), "name": ("M4'", "name")},
    ),
    "Remeshing": (
        lagrangian.Remeshing,
        {"name": ("M4'", "name"), "spacing": (0.1, "positive"), "above": (1.5, "positive"),
         "ends": ((0.0, 1.0), "optional pair")},
    ),
    "advance": (
        lagrangian.advance,
        {"x": (X, "particles"), "strength": (ONES, "line"), "velocity": (still, "function"), "dt": (0.1, "positive"),
         "steps": (1, "count"), "start": (0.0, "number"), "remeshing": (None, "optional object"),
         "threshold": (0.0, "not negative"), "observe": (None, "optional function")},
    ),
    "quotient_velocity": (
        lagrangian.quotient_velocity, {"flux": (X, "line"), "u": (ONES, "particles"), "x": (X, "line")}
    ),
    "ScatteredKernel": (
        scattered.ScatteredKernel,
        {"profile": (np.cos, "function"), "bandwidth": (1.0, "width"), "reach": (1.0, "width")},
    ),
    "smooth_kernel": (
        scattered.smooth_kernel, {"name": ("K", "name"), "alpha": (1.5, "number"), "order": (2, "count")}
    ),
    "scattered_sum": (
        scattered.scattered_sum,
        {"summation": ("fft", "name"), "kernels": ([GAUSSIAN], "object"), "epsilon": (1.0, "positive")},
    ),
    **{
        name: (getattr(scattered, name), {"kernels": ([GAUSSIAN], "object"), "epsilon": (1.0, "positive")})
        for name in ("NaiveScatteredSum", "NeighbourSum", "NonuniformFourierSum")
    },
    **{
        f"{name}.call": (getattr(scattered, name)([GAUSSIAN], 0.5), SUM)
        for name in ("NaiveScatteredSum", "NeighbourSum", "NonuniformFourierSum")
    },
}  # fmt: skip
BAD |= {
    "infinite rising": [*NO_NUMBERS, *COMPLEX, [], 1.0, np.ones((2, 2)), [1.0, 0.0]],
    "part": [*FIELD, 0.0, -1.0, [0.5, 1e9]],  # of a total: it ends where the total does
    "width": [v for v in BAD["positive"] if not (isinstance(v, float) and v in (np.inf, 1e-300))],
    "positive*": [v for v in BAD["positive"] if not (isinstance(v, float) and v == 1e-300)],
    "not negative*": [v for v in BAD["not negative"] if v is not None],
    "field*": [*FIELD, []],
    "line*": BAD["line"],
    "complex line*": BAD["complex line"],
    "optional pair": [v for v in BAD["pair"] if v is not None],
    "optional object": [v for v in BAD["object"] if v is not None],
    "any": [],
}  # fmt: skip


@at_once(CALLS)
def test_the_good_call_works(name):
    function, arguments = CALLS[name]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.simplefilter("ignore", AccuracyWarning)  # of ten particles
        function(**{key: value for key, (value, _) in arguments.items()})


@at_once([(name, argument) for name, (_, arguments) in CALLS.items() for argument in arguments])
def test_what_an_argument_is_not_is_refused(name, argument):
    """InvalidInput with a field, for every bad value; no other exception, no warning, no result."""
    function, arguments = CALLS[name]
    good = {key: value for key, (value, _) in arguments.items()}
    for bad in BAD[arguments[argument][1]]:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            try:
                result = function(**(good | {argument: bad}))
            except InvalidInput as error:
                assert error.field  # noqa: PT017 - of many values, the message names the bad one
                assert len(str(error)) < 1000  # noqa: PT017
                continue
            except Exception as error:
                pytest.fail(f"{name}({argument}={bad!r}) raises {type(error).__name__}: {error}")
        pytest.fail(f"{name}({argument}={bad!r}) is taken: {result!r}")


NOT_CALLED = {
    # Constants, types of functions and protocols, what is made by other calls, and errors.
    "BROOKSHAW_ETA", "COMPLETED", "FUNCTIONS", "METHODS", "SUPPORT", "SHAPES", "REMESHINGS", "Flux", "Kernel",
    "Profile", "ScatteredSum", "Function", "Extremes", "MarkerRun", "Elimination", "History", "FieldNotPositive",
    "MIDPOINT_LIMIT", "REMESHING", "REMESH_ABOVE", "THRESHOLD",
    # No argument, or inside `run` only.
    "Gaussian", "Square", "Tent", "diffusion", "kdv", "Shape",
}  # fmt: skip


@at_once(MODULES)
def test_every_public_name_is_tried(module):
    named = set(MODULES[module].__all__) - NOT_CALLED
    tried = {part for name in CALLS for part in (name, name.rpartition(".")[2])}
    assert named <= tried
