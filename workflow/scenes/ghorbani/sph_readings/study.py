"""What the text leaves open about its sums, each choice changed in turn, and its equations as printed."""

from collections.abc import Iterator, Mapping

import numpy as np
import pandas as pd

from fracparticles.sph import ParticleLine
from fracparticles.sph.closed_forms import FUNCTIONS
from fracparticles.sph.cubic_spline import SUPPORT, spline_integral
from fracparticles.sph.derivatives import correction, gradient, second_derivative
from fracparticles.sph.norms import relative_l2
from fracstudy.findings import Finding, measured
from fracstudy.inputs import Inputs, Result
from scenes.ghorbani import operators
from scenes.ghorbani.operators import CURVATURES, LABELS, OPERATORS, SLOPES, Order, order_at
from scenes.ghorbani.sph_readings import kernel
from scenes.ghorbani.sph_readings.sums import Reading, approximate

_DIGITS, _SINGULAR = "that of the digits", "singular sums (23), (25), (26)"
_ETA = "η = 0.0001 / h², (37) as printed"
READINGS = {
    _DIGITS: Reading(),
    "no terms j > i": Reading(ahead="none"),
    "terms j > i with |x_i - x_j|": Reading(ahead="absolute"),
    "norms of the real part": Reading(real=True),
    "gradients not corrected": Reading(correction="none"),
    "gradients times L, (19) as printed": Reading(correction="multiplied"),
    "no virtual particles": Reading(virtual=False),
    "exact f', f''": Reading(exact=True),
    _ETA: Reading(eta="1/h^2"),
    _SINGULAR: Reading(singular=True),
    "half volumes at the two ends": Reading(halved=True),
    "x = 0 judged for the RL derivative": Reading(first=True),
    "(20) with f' at the auxiliary particle": Reading(midpoint="itself"),
    "(20) with the average of f' times the power": Reading(midpoint="product"),
    "(20) with N auxiliary particles": Reading(last=True),
}
# Figure: operator, function, whether of variable order, whether by the modified sums.
CASES = {
    "Fig. 3, cos": ("caputo", "cos", False, False),
    "Fig. 4, sin": ("rl_derivative", "sin", False, False),
    "Fig. 5, sin": ("rl_integral", "sin", False, False),
    "Fig. 6, sin": ("rl_integral", "sin", False, True),
    "Fig. 7, cos": ("caputo", "cos", True, False),
    "Fig. 8, sin": ("rl_integral", "sin", True, False),
}


def study(
    inputs: Inputs,
    *,
    order: float,
    variable: dict[str, float],
    length: float,
    count: int,
    smoothing_ratio: float,
) -> Result:
    """Change one choice at a time, and measure what the equations as printed give.

    A row of the table agrees in the figures whose six decimals it does not change.
    """
    line = ParticleLine(0.0, length, count, smoothing_ratio)
    orders: list[Order] = [order, variable]
    errors = {name: _errors(line, orders, reading) for name, reading in READINGS.items()}
    # In whole millionths: six decimals are printed.
    table = 1e6 * pd.DataFrame.from_dict(errors, orient="index")
    table = table.round().astype(int).rename(columns="{}, L2 × 10⁶".format)
    table["figures with the same digits"] = (table == table.iloc[0]).sum(axis=1)
    findings = [
        *kernel.findings(line),
        *_gradients(line),
        _auxiliary(line),
        _double_sum(line, order, variable),
        *_orders(line, variable),
        *_singularity(line, order, table, errors),
        _eta(line, errors),
        _score(line, orders),
        _right_handed(line, order),
    ]
    table = table.reset_index(names="reading")
    return Result(table, inputs.judged(findings))


def _errors(line: ParticleLine, orders: list[Order], reading: Reading) -> dict[str, float]:
    errors = {}
    for case, (operator, name, varies, modified) in CASES.items():
        kind, alpha = OPERATORS[operator], order_at(orders[varies], line.x_all)
        judged = slice(0 if reading.first else kind.first, None)
        exact = kind.exact(FUNCTIONS[name], line.x, alpha[line.inside])
        ours = approximate(line, name, operator, alpha, modified, reading)[judged]
        errors[case] = relative_l2(exact[judged], ours.real if reading.real else ours)
    return errors


def _gradients(line: ParticleLine) -> Iterator[Finding]:
    """(18), (19) on f = 1, on f = x and on the four functions."""
    x, volume, h = line.x_all, line.spacing, line.smoothing

    def plain(f: np.ndarray) -> np.ndarray:
        return gradient(line.x, x, volume, f, h, corrected=False)

    factor, of_x = correction(line.x, x, volume, h), plain(x)
    of_one = np.abs(plain(np.ones_like(x))).max() * h
    gradients = (of_x, of_x / factor, of_x * factor)
    regular, corrected, printed = (np.abs(g - 1.0).max() for g in gradients)
    yield measured("S-EQ.consistency", of_one=of_one, of_x=corrected)
    yield measured("S-EQ.consistency_regular", of_one=of_one, of_x=regular)
    yield measured("S-EQ.L_inverse", printed=printed, plain=regular, meant=corrected)
    ratio = {}
    for name, function in FUNCTIONS.items():
        exact, ours = SLOPES[name](line.x), plain(function.value(x))
        ratio[LABELS[name]] = relative_l2(exact, ours / factor) / relative_l2(exact, ours)
    yield measured("S-EQ.correction", ratio=ratio)


def _auxiliary(line: ParticleLine) -> Finding:
    """(20): the volume of N auxiliary particles, and of the midpoints there are, against the length."""
    numbers = (line.count, line.midpoints.size)
    printed, meant = (abs(n * line.spacing / (line.b - line.a) - 1.0) for n in numbers)
    return measured("S-EQ.auxiliary", printed=printed, meant=meant, count=line.count)


def _double_sum(line: ParticleLine, order: float, variable: dict[str, float]) -> Finding:
    """(25), (31): with the integral at x_i inside the sum over j, it is a factor of sum_j V_j dW_ij = 0."""
    sine, here = FUNCTIONS["sin"], line.x[1:-1]
    vanishing = gradient(line.x, line.x_all, line.spacing, np.ones_like(line.x_all), line.smoothing)

    def errors(kind: Order, exact: np.ndarray) -> tuple[float, float]:
        alpha = order_at(kind, line.x_all)
        inner = approximate(line, "sin", "rl_integral", 1.0 - alpha, False, Reading())
        ours = OPERATORS["rl_derivative"].approximate(line, sine.value(line.x_all), alpha)
        printed, meant = (relative_l2(exact, v[1:-1]) for v in (inner * vanishing, ours))
        return printed, meant

    printed, meant = errors(order, sine.rl(here, order))
    # There is no closed form for the derivative of variable order, but for the integral.
    exact = operators.central_slope(lambda x: sine.rl(x, order_at(variable, x) - 1.0), here)
    both = dict(zip(("printed", "meant"), errors(variable, exact), strict=True))
    return measured("S-EQ.double_sum", printed=printed, meant=meant, variable=both)


def _orders(line: ParticleLine, variable: dict[str, float]) -> Iterator[Finding]:
    """The left side of (32), and the range of alpha(x)."""
    alpha = order_at(variable, line.x_all)
    ours = approximate(line, "sin", "caputo", alpha, False, Reading())
    order, exact = alpha[line.inside], FUNCTIONS["sin"].caputo
    printed, meant = (relative_l2(exact(line.x, a), ours) for a in (1.0 - order, order))
    yield measured("S-EQ.caputo_order", printed=printed, meant=meant)
    yield measured("S-EQ.order_range", least=order.min(), greatest=order.max())


def _singularity(
    line: ParticleLine, order: float, table: pd.DataFrame, errors: Mapping[str, Mapping[str, float]]
) -> Iterator[Finding]:
    """Sec. 5: the infinite terms of (23), what the sums without them give, and what a derivative costs."""
    singular, ours = (pd.Series(errors[name]) for name in (_SINGULAR, _DIGITS))
    distance = line.x[:, None] - line.x
    share = spline_integral(distance, line.smoothing)
    infinite = (distance == 0.0) & (share > 0.0) & (order < 1.0)
    finite = np.count_nonzero(~infinite.any(axis=1))
    yield measured("S-EQ.singular", finite=finite, ratio=dict(singular / ours))
    same = table["figures with the same digits"][_SINGULAR]
    yield measured("S-EQ.non_singular", figures=same)
    apart = np.abs(line.x[:, None] - line.x_all)
    near = np.count_nonzero((apart > 0.0) & (apart < SUPPORT * line.smoothing))
    terms, count = np.count_nonzero(share > 0.0), line.count
    yield measured("S-EQ.cost", share=near / terms, near=near / count, terms=terms / count)


def _eta(line: ParticleLine, errors: Mapping[str, Mapping[str, float]]) -> Finding:
    """(37) with eta as printed, with 0.0001 h^2 and with none, for f'' of cos(pi x)."""
    h, case = line.smoothing, "Fig. 3, cos"
    f, exact = FUNCTIONS["cos"].value(line.x_all), CURVATURES["cos"](line.x)

    def error(eta: float) -> float:
        here, x, s = f[line.inside], line.x_all, line.spacing
        return relative_l2(exact, second_derivative(line.x, here, x, s, f, h, eta))

    printed, meant, without = map(error, (1e-4 / h**2, 1e-4 * h**2, 0.0))
    return measured(
        "S-EQ.eta",
        printed=printed,
        meant=meant,
        without=without,
        eta=1e-4 / h**2,
        over_h=1e-4 / h**3,
        caputo=errors[_ETA][case],
        caputo_meant=errors[_DIGITS][case],
    )


def _score(line: ParticleLine, orders: list[Order]) -> Finding:
    """(40), with the squares of the complex deviations as printed and with those of their absolute values."""
    plain, absolute = {}, {}
    for case, (operator, name, varies, _) in CASES.items():
        for method in ("standard", "modified"):
            _, exact, ours = OPERATORS[operator].compared(line, name, orders[varies], method)
            off, spread = ours - exact, np.sum((exact - exact.mean()) ** 2)
            plain[case, method] = 1.0 - np.sum(off**2).real / spread
            absolute[case, method] = 1.0 - np.sum(np.abs(off) ** 2) / spread
    return measured(
        "S-EQ.score",
        excess=max(plain.values()) - 1.0,
        meant=max(absolute.values()) - 1.0,
        short=1.0 - max(absolute.values()),
        plain=plain["Fig. 4, sin", "standard"],
        absolute=absolute["Fig. 4, sin", "standard"],
    )


def _right_handed(line: ParticleLine, order: float) -> Finding:
    """The operators on [x, b] of exp x, whose mirror image has closed forms."""
    errors = {}
    for kind in OPERATORS.values():
        _, exact, ours = kind.compared(line, "exp", order, side="right")
        errors[kind.name] = relative_l2(exact, ours)
    return measured("S-EQ.right_handed", error=errors)
