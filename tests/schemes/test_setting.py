"""Where the particles of a setting are."""

from __future__ import annotations

import numpy as np

from fracparticles.schemes import Setting


def test_particles_lie_on_the_lattice_about_the_origin():
    setting = Setting(alpha=1.5, dim=2, n=3, spacing=0.25)
    x, y = setting.positions
    assert np.array_equal(setting.x, [-0.75, -0.5, -0.25, 0.0, 0.25, 0.5, 0.75])
    assert np.broadcast(x, y).shape == setting.shape
    assert (x[5, 0], y[0, 5]) == (0.5, 0.5)
