"""Where the particles of a setting are."""

from __future__ import annotations

import numpy as np
import pytest

from fracparticles.errors import InvalidInput
from fracparticles.schemes import Setting


def test_particles_lie_on_the_lattice_about_the_origin():
    setting = Setting(alpha=1.5, dim=2, n=3, spacing=0.25)
    x, y = setting.positions
    assert np.array_equal(setting.x, [-0.75, -0.5, -0.25, 0.0, 0.25, 0.5, 0.75])
    assert np.broadcast(x, y).shape == setting.shape
    assert (x[5, 0], y[0, 5]) == (0.5, 0.5)


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("alpha", 2.0),
        ("order", 2.5),
        ("overlap", np.inf),
        ("dim", 4),
        ("n", -1),
        ("spacing", np.nan),
        ("diffusivity", -1.0),
        ("summation", "fast"),
        ("exterior", "Open"),
        ("far_terms", 4),
    ],
)
def test_what_is_no_lattice_is_refused_with_its_field(field, value):
    """Operators of such a setting would be nan, zero, of growing waves, or truncated where "Open" was asked for."""
    with pytest.raises(InvalidInput, match=f"^{field} = "):
        Setting(**{"alpha": 1.5, "n": 20, "spacing": 0.25, field: value})
