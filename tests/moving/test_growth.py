"""A displacement wave grows in a midpoint step by 1 + z + z^2 / 2 of the symbol of DD."""

from __future__ import annotations

import pytest

from fracparticles.errors import InvalidInput
from fracparticles.kernels.families import kernel_transform
from fracparticles.moving.diffusion_velocity import DiffusionVelocity
from fracparticles.moving.growth import displacement_growth
from fracparticles.schemes import Setting
from fracparticles.schemes.stability import stability_limit, worst_wave


@pytest.mark.parametrize("order", [2, 4])
@pytest.mark.parametrize("overlap", [2.0, 3.0])
@pytest.mark.parametrize("factor", [0.5, 1.0, 1.3])
def test_a_displacement_wave_has_the_symbol_of_dd(order, overlap, factor):
    alpha = 1.5
    theta = worst_wave("DD", Setting(alpha=alpha, order=order, overlap=overlap))
    step = factor * stability_limit("DD", alpha - 1.0, order, overlap)
    damping = theta**alpha * kernel_transform("eta", overlap * theta, alpha, order=order)
    z = -step * damping
    found = displacement_growth(DiffusionVelocity(alpha, order, overlap), step, theta, half=300)
    # The ends are felt in the middle like (k half)^-alpha; displacements are small to 1e-5.
    assert found == pytest.approx(1.0 + z + 0.5 * z * z, abs=3e-3)
    assert z == pytest.approx(-2.0 * factor, rel=3e-3)  # aliases are neglected in z


@pytest.mark.parametrize(
    ("field", "bad"),
    [("dt", 0.0), ("dt", float("nan")), ("theta", -1.0), ("half", 0), ("half", 2.5)],
)
def test_bad_input_is_refused(field, bad):
    given = {"dt": 0.1, "theta": 1.0, "half": 50, field: bad}
    with pytest.raises(InvalidInput) as refusal:
        displacement_growth(DiffusionVelocity(1.5, 2, 2.0), **given)
    assert refusal.value.field == field
