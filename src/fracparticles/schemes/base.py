"""The classes of schemes; a `Sum` or an `Exchange` gives its weights and its transform only."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from fracparticles.errors import InvalidInput, one_of
from fracparticles.kernels.families import family_of
from fracparticles.lattice.exterior import far_field
from fracparticles.lattice.exterior_box import box_far_field
from fracparticles.lattice.operators import ConvolutionOperator, FarField, LatticeOperator
from fracparticles.lattice.sums import BOX_SUMMATIONS, SUMMATIONS, sums_of_weights
from fracparticles.schemes.agreement import refuse_disagreement
from fracparticles.schemes.setting import Setting
from fracparticles.schemes.transform import lattice_transform

__all__ = ["Exchange", "LatticeScheme", "OnePass", "Scheme", "Sum", "one_pass_operator", "radius"]

Function = Callable[[np.ndarray], np.ndarray]

# A scheme that overrides one of these may contradict itself: its weights and its transform are compared.
_OWN = ("values", "transform", "weights", "scaled_transform")


class Scheme:
    """What every scheme provides. A scheme is a class with a `name`, in a module of this folder."""

    name: str  # the abbreviation, as in tables
    title: str  # the name in words
    equation: str  # the equation of the paper
    kernel: str = "-"  # the equation of the kernel
    place: int = 100  # in lists; schemes that set none come last
    rejected: bool = False  # the paper only mentions it
    orders: tuple[int, ...] = (2,)  # of the kernels in one dimension
    box_orders: tuple[int, ...] = ()  # of the kernels in two and three dimensions
    families: tuple[str, ...] = ()  # of kernels, where there is a choice
    exteriors: tuple[str, ...] = ("truncated",)
    conservative: bool  # the total strength is invariant (18)
    moving: bool = False  # the particles move: there is no operator on the lattice
    symbol_of: str = ""  # the scheme whose symbol gives the decay of its waves, if not its own
    has_kernel: bool = True  # there is a smoothing length epsilon
    tabulated: bool = False  # the kernels may be interpolated in a table
    self_timed: bool = False  # epsilon = (D dt)^(1/alpha) is tied to the step, which is Euler's
    colour: str = "#000000"  # in figures
    marker: str = "."

    @property
    def dims(self) -> tuple[int, ...]:
        """Space dimensions."""
        return (1, 2, 3) if self.box_orders else (1,)

    def check(self, dim: int, order: int, family: str | None, field: str = "family") -> None:
        """Refuse settings for which the scheme does not exist. `field` is the caller's name for the kernel family.

        Raises
        ------
        InvalidInput
            With the field, the value, and what is allowed.
        """
        _choose("dim", dim, self.dims, self.name)
        if dim == 1:
            _choose("order", order, self.orders, self.name)
        else:
            _choose("order", order, self.box_orders, f"{self.name} in {dim} dimensions")
        if family is not None:
            if not self.families:
                raise InvalidInput(field, family, f"nothing for {self.name}", "Leave it out.")
            family_of(order, family, field)

    def padding(self, order: int, overlap: float, dim: int, family: str | None) -> int:
        """Return the number of lattice points beyond each end at which an open exterior needs sums."""
        return 0


def _choose(field: str, value: object, choices: tuple[int, ...], where: str) -> None:
    if not (is_number(value) and value in choices):
        raise one_of(field, value, choices, where, "Choose one of these, or another scheme.")


def is_number(value: object) -> bool:
    """Return whether a value is a real number, of Python's or of NumPy's, and no bool."""
    return isinstance(value, (int, float, np.integer, np.floating)) and not isinstance(value, bool)


class LatticeScheme(Scheme, ABC):
    """A scheme whose particles stay on the lattice x_i = i h. All have the form

        du_i/dt = (D / h^alpha) sum_j a_{i-j} u_j + boundary terms,

    with weights a_m that depend only on alpha, the order and the overlap s = epsilon / h.
    """

    # No eigenvalue of a bounded lattice lies above the range of the symbol.
    dissipative: bool = True

    @abstractmethod
    def operator(self, setting: Setting) -> LatticeOperator:
        """Return A of du/dt = A u on the lattice."""

    @abstractmethod
    def symbol(self, theta: np.ndarray, setting: Setting) -> np.ndarray:
        """Return A(theta) h^alpha / D on the infinite lattice, theta = k h in [0, pi].

        For dim > 1 the last axis of theta is the vector.
        """

    def ends_amplify(self, setting: Setting) -> bool:
        """Return whether the ends of a bounded lattice, of any size, make eigenvalues a little above zero."""
        return False

    def closed_form_limit(self, beta: float, overlap: float) -> float:
        """Return the stability limit a for order II in closed form, neglecting the aliases of the lattice.

        Raises
        ------
        InvalidInput
            If there is no closed form.
        """
        raise InvalidInput(
            "scheme", self.name, "one with a closed form", "Use stability_limit for the others."
        )


class OnePass(LatticeScheme):
    """A scheme with a single even sum, (c D / epsilon^alpha) sum_j V_j u_j K_epsilon(x_i - x_j) or its exchange form.

    A subclass names K, or provides `values` and `transform` of its own kernel.
    """

    kernel_name: str  # K, see `kernels.kernel`

    def factor(self, setting: Setting) -> float:
        """Return c."""
        return 1.0

    def values(self, r: np.ndarray, setting: Setting) -> np.ndarray:
        """Return K(r), r in units of epsilon."""
        return setting.kernel(self.kernel_name, r)

    def transform(self, theta: np.ndarray, setting: Setting) -> np.ndarray:
        """Return sum_m K(m / s) e^{-i m.theta} / s^n; see `lattice_transform`."""
        return lattice_transform(self.kernel_name, theta, setting)

    def weights(self, m: np.ndarray, setting: Setting) -> np.ndarray:
        """Return a_m = c s^(-n-alpha) K(|m| / s)."""
        s = setting.overlap
        scale = self.factor(setting) * s ** (-setting.dim - setting.alpha)
        return scale * self.values(m / s, setting)

    def scaled_transform(self, theta: np.ndarray, setting: Setting) -> np.ndarray:
        """Return the transform of the weights, c s^(-alpha) times that of the kernel."""
        return self._scale(setting) * self.transform(theta, setting)

    def _scale(self, setting: Setting) -> float:
        return self.factor(setting) * setting.overlap**-setting.alpha

    def _operator(self, setting: Setting, exchange_sum: float | None) -> LatticeOperator:
        exact = replace(setting, kernel_table=None)
        if any(getattr(type(self), name) is not getattr(OnePass, name) for name in _OWN):
            claimed = self.symbol if exchange_sum is None else self.scaled_transform
            refuse_disagreement(self.name, self.weights, claimed, setting)
        return one_pass_operator(
            setting,
            lambda m: self.weights(m, setting),
            exchange_sum,
            lambda theta: self.scaled_transform(theta, exact),
            lambda m: self.weights(m, exact),
        )


class Sum(OnePass):
    """du_i/dt = (c D / epsilon^alpha) sum_j V_j u_j K_epsilon(x_i - x_j)."""

    def operator(self, setting: Setting) -> LatticeOperator:
        """Return A."""
        return self._operator(setting, None)

    def symbol(self, theta: np.ndarray, setting: Setting) -> np.ndarray:
        """Return A(theta) h^alpha / D = c s^(-alpha) sum_l K^(s (theta + 2 pi l))."""
        return self.scaled_transform(theta, setting)


class Exchange(OnePass):
    """du_i/dt = (c D / epsilon^alpha) sum_j V_j (u_j - u_i) K_epsilon(x_j - x_i): conservative."""

    conservative = True

    def operator(self, setting: Setting) -> LatticeOperator:
        """Return A."""
        total = self.scaled_transform(np.zeros((1, setting.dim)), setting).flat[0]
        return self._operator(setting, float(total))

    def symbol(self, theta: np.ndarray, setting: Setting) -> np.ndarray:
        """Return A(theta) h^alpha / D = c s^(-alpha) sum_l [K^(s (theta + 2 pi l)) - K^(2 pi l s)]."""
        at_zero = self.transform(np.zeros((1, setting.dim)), setting).flat[0]
        return self._scale(setting) * (self.transform(theta, setting) - at_zero)


def one_pass_operator(
    setting: Setting,
    weights: Function,
    exchange_sum: float | None = None,
    transform: Function | None = None,
    exact_weights: Function | None = None,
) -> ConvolutionOperator:
    """Return the operator of a single even sum, du_i/dt = sum_j w_{i-j} (u_j - [u_i]).

    Parameters
    ----------
    setting : Setting
    weights : callable
        a_m of the scheme as a function of the offset |m|, in units of D / h^alpha; for an open exterior
        a_m ~ |m|^(-n-alpha).
    exchange_sum : float, optional
        For a particle strength exchange, sum_j a_j (u_j - u_i): the sum of a_m over the infinite lattice, from
        the transform. None if the scheme has no - u_i.
    transform : callable, optional
        sum_m a_m e^{-i m.theta}, for an open exterior in two and three dimensions.
    exact_weights : callable, optional
        The weights that have this transform, since `weights` may come from a table. The exterior is made of them.
    """
    size, dim, rate = setting.size, setting.dim, setting.rate
    far: FarField | None = None
    exact_weights = exact_weights or weights
    m = np.arange(size, dtype=float)
    convolve: Function
    if dim == 1:
        w = rate * weights(m)
        convolve = SUMMATIONS[setting.summation](w, size)
        if setting.is_open:
            far = far_field(
                lambda offset: rate * exact_weights(offset),
                1.0 + setting.alpha,
                setting.alpha,
                setting.n,
                terms=setting.far_terms,
            )
    else:
        convolve = _box_sums(setting, weights)
        if setting.is_open and transform is not None:
            exact = exactly_summed(setting)
            inside = convolve if exact == setting else _box_sums(exact, exact_weights)
            far = box_far_field(
                lambda theta: rate * transform(theta),
                lambda u: inside(u).reshape(u.shape),
                setting.alpha,
                setting.n,
                dim,
            )
    particles = size**dim
    if exchange_sum is None:
        return ConvolutionOperator(convolve, np.zeros(particles), far, dim=dim)
    infinite = -rate * exchange_sum
    if not setting.is_open:
        diagonal = (
            -sums_of_weights(w, parity=1, size=size) if dim == 1 else -convolve(np.ones(particles))
        )
    elif setting.kernel_table is None or transform is None:
        diagonal = np.full(particles, infinite)
    else:  # the table within the lattice, exact weights beyond it; so a constant u stays constant
        diagonal = np.full(particles, -rate * transform(np.zeros((1, dim))).flat[0])
        if dim == 1:
            diagonal -= sums_of_weights(w - rate * exact_weights(m), parity=1, size=size)
        else:
            diagonal += inside(np.ones(particles)) - convolve(np.ones(particles))
    return ConvolutionOperator(convolve, diagonal, far, infinite, dim)


def exactly_summed(setting: Setting) -> Setting:
    """Return the setting without a table and with fast sums; the exterior of a box is made from these."""
    return replace(setting, kernel_table=None, summation="fft")


def _box_sums(setting: Setting, weights: Function) -> Function:
    w = setting.rate * weights(lattice_radii(setting.size, setting.dim))
    sums = BOX_SUMMATIONS[setting.summation]([w], [None], setting.size, setting.size)
    return lambda u: sums(u.reshape(setting.shape)).reshape(-1)


def radius(m: tuple[np.ndarray, ...]) -> np.ndarray:
    """Return |m| from its coordinates."""
    return np.sqrt(sum(np.square(part) for part in m))


def lattice_radii(count: int, dim: int) -> np.ndarray:
    """Return |m| for m = 0 .. count - 1 in each coordinate, shape (count,) * dim."""
    return radius(np.meshgrid(*(np.arange(count, dtype=float),) * dim, indexing="ij", sparse=True))
