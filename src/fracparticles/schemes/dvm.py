"""The diffusion velocity method (DVM) as a scheme whose particles move, see `moving.dvm`."""

from __future__ import annotations

from fracparticles.schemes.base import Scheme


class DiffusionVelocityMethod(Scheme):
    """DVM. A wave of displacements of its particles in a uniform field decays by the symbol of DD."""

    name, place = "DVM", 6
    title = "Diffusion velocity method"
    equation, kernel = "Eqs. (42)-(45)", "Eqs. (8), (9), (20), (21)"
    orders = (2, 4)
    exteriors = ("truncated", "open")
    conservative = True
    moving = True
    symbol_of = "DD"
    colour, marker = "#7F3C8D", "p"  # not Okabe & Ito's last colour: yellow is too pale for lines
