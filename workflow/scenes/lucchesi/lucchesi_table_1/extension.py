"""Sec. 6: which schemes extend to a diffusivity D(x), u_t = div(D grad^beta u)."""

import numpy as np

from fracparticles.run.orders import observed_order
from fracparticles.schemes import Setting
from fracparticles.variable import VariableDiffusivity
from fracparticles.variable.closed_forms import Cauchy
from fracstudy.errors import off
from fracstudy.findings import Finding, measured

_FORMS = {"DD": "DD", "FPSE": "FPSE", "KPSE": "exchange"}


def variable_diffusivity(
    alpha: float, amplitude: float, half_width: float, spacings: list[float]
) -> list[Finding]:
    """Return the order of each scheme with D = 1 + c u for u = 1 / (1 + x^2), between the two finest lattices.

    KPSE takes the mean D of each pair: with that of one particle the exchange would not conserve.
    """
    orders, errors = {}, {}
    for scheme, form in _FORMS.items():
        found = np.array([_error(form, alpha, amplitude, half_width, h) for h in spacings])
        orders[scheme] = observed_order(np.array(spacings), found)[-1]
        errors[scheme] = found[-1]
    kept = {scheme: abs(orders[scheme] - 2.0) for scheme in ("DD", "FPSE")}
    return [
        measured("L-COST.amenable", order=kept),
        measured("L-COST.complicated", order=orders["KPSE"], error=errors["KPSE"]),
    ]


def _error(form: str, alpha: float, c: float, half_width: float, h: float) -> float:
    """The greatest error of the operator over the greatest value of div(D grad^beta u)."""
    s = Setting(n=round(half_width / h), spacing=h, alpha=alpha, exterior="open", far_terms=3)
    operator = VariableDiffusivity(form, s, tail=2.0)
    x = [h * np.arange(-s.n, s.n + 1.0)]
    u, d = Cauchy.value(x), 1.0 + c * Cauchy.value(operator.points)
    slope = [c * part for part in Cauchy.gradient(x, 2.0)]  # beta = 1 is the gradient
    exact = Cauchy.flux_divergence(x, alpha, 1.0 + c * u, slope)
    return off(operator.apply(u, d), exact)
