"""Write report/reference/stable_density.csv: the reduced Green function L_alpha^0 to 25 digits.

Run by hand where the points change: python tools/make_stable_reference.py

    L(x) = (1/pi) Re int_0^inf exp(i k x - k^alpha) dk,

along k = t exp(i phi), phi = pi / (4 alpha), where the integrand decays like exp(-t x sin(phi)) and
exp(-t^alpha cos(pi/4)); mpmath's tanh-sinh quadrature on intervals of geometric length, 60 digits. Independent of
the package, which is checked against these values; the tests check the values themselves by series.
"""

from __future__ import annotations

from pathlib import Path

import mpmath as mp

ALPHAS = ("1.05", "1.1", "1.5", "1.9", "1.99")
EXPONENTS = range(-12, 25)  # x = 10^(k/4): from 1e-3 to 1e6
DIGITS = 25
TARGET = Path(__file__).resolve().parent.parent / "report/reference/stable_density.csv"


def positions() -> list[str]:
    """Return the x, as short decimals."""
    return ["0", *(f"{10.0 ** (k / 4):.3g}" for k in EXPONENTS)]


def density(x: float, alpha: float) -> mp.mpf:
    """Return L_alpha^0(x) for the float64 numbers given."""
    with mp.workdps(60):
        x, alpha = mp.mpf(x), mp.mpf(alpha)
        direction = mp.expj(mp.pi / (4 * alpha))

        def integrand(t: mp.mpf) -> mp.mpf:
            k = t * direction
            return mp.re(mp.exp(mp.j * k * x - t**alpha * mp.expj(mp.pi / 4)) * direction)

        # The shorter of the two lengths of decay, and 60 digits of it: exp(-140).
        length = min(1 / (x * mp.sin(mp.arg(direction))) if x else mp.inf, mp.mpf(2))
        ends = [mp.mpf(0), *(length * 2**k for k in range(-2, 8))]
        return mp.quad(integrand, ends) / mp.pi


def main() -> None:
    """Write the file."""
    lines = ["alpha,x,density"]
    for alpha in ALPHAS:
        for x in positions():
            lines.append(f"{alpha},{x},{mp.nstr(density(float(x), float(alpha)), DIGITS)}")
    TARGET.parent.mkdir(parents=True, exist_ok=True)
    TARGET.write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
