"""Special functions: stable densities and confluent hypergeometric functions."""

from __future__ import annotations

from fracparticles.special.hypergeometric import kummer, kummer_order_four, kummer_transformed
from fracparticles.special.stable import (
    central_mass,
    green,
    green_asymptotic,
    green_flux,
    green_rate,
    green_series,
    green_slope,
    mean_radius,
    reduced_green,
    tail_mass,
)
from fracparticles.special.tails import exchange_truncation_error, tail_constant

__all__ = [
    "central_mass",
    "exchange_truncation_error",
    "green",
    "green_asymptotic",
    "green_flux",
    "green_rate",
    "green_series",
    "green_slope",
    "kummer",
    "kummer_order_four",
    "kummer_transformed",
    "mean_radius",
    "reduced_green",
    "tail_constant",
    "tail_mass",
]
