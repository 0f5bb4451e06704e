"""The printed kernel family of Lucchesi et al. (2020), whose equation numbers are given: orders II and IV.

With M(a, b, z) = 1F1(a; b; -z), orders II and IV differ in one rule:

    order II:  M(a, b, r^2)
    order IV:  2 M(a, b, r^2) - 2^-a M(a, b, r^2 / 2)

This is (B.18), which misprints the last argument; compare (12), (15), (21). In Fourier space the rule is
2 f(k) - f(sqrt(2) k) for the two Gaussians of (8) and (9).
"""

from __future__ import annotations

import math

import numpy as np
from scipy.special import gamma, gammaincc

from fracparticles.arguments import FloatArray
from fracparticles.kernels.rules import KernelFamily
from fracparticles.special.hypergeometric import kummer_order_four, kummer_transformed
from fracparticles.special.stable import reduced_green

__all__ = ["PRINTED"]


def _gaussian(r: FloatArray, n: int) -> FloatArray:
    return np.exp(-r * r) / math.pi ** (0.5 * n)


def _wide_gaussian(r: FloatArray, n: int) -> FloatArray:
    return np.exp(-0.5 * r * r) / (2.0 * math.pi) ** (0.5 * n)


class _Printed(KernelFamily):
    orders = (2, 4)
    names = (*KernelFamily.names, "E")

    def m(self, c: float, b: float, r: FloatArray, order: int) -> FloatArray:
        """M(b - c, b, r^2) in order II or IV (B.18)."""
        rule = kummer_transformed if order == 2 else kummer_order_four
        return np.asarray(rule(c, b, r * r))

    def eta(self, r: FloatArray, alpha: float, n: int, order: int) -> FloatArray:
        """pi^(-n/2) exp(-r^2)  (8);  2 pi^(-n/2) exp(-r^2) - (2 pi)^(-n/2) exp(-r^2/2)  (9)."""
        narrow = _gaussian(r, n)
        return narrow if order == 2 else 2.0 * narrow - _wide_gaussian(r, n)

    def eta1(self, r: FloatArray, alpha: float, n: int, order: int) -> FloatArray:
        """-2 r pi^(-n/2) exp(-r^2)  (23);  -(n + 4 - 2 r^2) r pi^(-n/2) exp(-r^2).

        (24) prints 5 - 2 r^2, which is n = 1; the second-moment condition gives n + 4.
        """
        if order == 2:
            return -2.0 * r * _gaussian(r, n)
        return -(n + 4.0 - 2.0 * r * r) * (r * _gaussian(r, n))

    def phi(self, r: FloatArray, alpha: float, n: int, order: int) -> FloatArray:
        """2 pi^(-n/2) exp(-r^2)  (17); in order IV -(1/r) d/dr of (9)."""
        narrow = _gaussian(r, n)
        return 2.0 * narrow if order == 2 else 4.0 * narrow - _wide_gaussian(r, n)

    def e(self, r: FloatArray, alpha: float, n: int, order: int) -> FloatArray:
        """L_alpha^0  (39); Phi_{n,alpha} of (57), (58) in n dimensions."""
        return np.asarray(reduced_green(r, alpha, n))

    def eta_hat(self, k: FloatArray, alpha: float, n: int, order: int) -> FloatArray:
        """exp(-k^2/4);  2 exp(-k^2/4) - exp(-k^2/2)."""
        narrow = np.exp(-0.25 * k * k)
        return narrow if order == 2 else 2.0 * narrow - np.exp(-0.5 * k * k)

    def eta1_hat(self, k: FloatArray, alpha: float, n: int, order: int) -> FloatArray:
        """k exp(-k^2/4);  k (1 + k^2/4) exp(-k^2/4), for every n.

        Order IV is the gradient of ((n + 2)/2 - r^2) pi^(-n/2) exp(-r^2).
        """
        return k * np.exp(-0.25 * k * k) * (1.0 if order == 2 else 1.0 + 0.25 * k * k)

    def phi_hat(self, k: FloatArray, alpha: float, n: int, order: int) -> FloatArray:
        """2 exp(-k^2/4);  4 exp(-k^2/4) - exp(-k^2/2)."""
        narrow = np.exp(-0.25 * k * k)
        return 2.0 * narrow if order == 2 else 4.0 * narrow - np.exp(-0.5 * k * k)

    def k_hat(self, k: FloatArray, alpha: float, n: int, order: int) -> FloatArray:
        """2^beta Gamma(s, k^2/4);  2^alpha Gamma(s, k^2/4) - 2^(s-1) Gamma(s, k^2/2),  s = alpha/2.

        For every n; Gamma(s, x) is the upper incomplete gamma function.
        """
        s = 0.5 * alpha
        narrow = 2.0 ** (alpha - 1.0) * gamma(s) * gammaincc(s, 0.25 * k * k)
        if order == 2:
            return narrow
        return 2.0 * narrow - 2.0 ** (s - 1.0) * gamma(s) * gammaincc(s, 0.5 * k * k)

    def e_hat(self, k: FloatArray, alpha: float, n: int, order: int) -> FloatArray:
        """exp(-k^alpha)."""
        return np.exp(-(k**alpha))


PRINTED = _Printed()
