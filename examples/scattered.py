"""# Diffusion between scattered particles

Strength exchange needs no lattice: two particles exchange strength through a kernel of their distance, weighted with
their volumes. Here the particles of a square are shaken at random. A Gaussian blob spreads by u_t = u_xx + u_yy, and
the exact solution is known. What one particle gives, another gets, so the total is kept.
"""

import matplotlib.pyplot as plt
import numpy as np

from fracparticles.pse import StrengthExchange, construct_laplacian

rng = np.random.default_rng(1)
h, dt, t0, t = 0.1, 5.0e-4, 0.25, 0.5
side = np.arange(-4.0, 4.0, h) + h / 2
points = np.stack(np.meshgrid(side, side), axis=-1).reshape(-1, 2)
points += rng.uniform(-0.2 * h, 0.2 * h, points.shape)
volumes = np.full(len(points), h * h)


def blob(time):
    """Return the exact solution at the particles."""
    r2 = (points**2).sum(axis=1)
    return np.exp(-r2 / (4.0 * time)) / (4.0 * np.pi * time)


exchange = StrengthExchange(points, volumes, 2.0 * h, construct_laplacian(2, dim=2))
u = blob(t0)
total = volumes @ u
for _ in range(round((t - t0) / dt)):
    u += dt * exchange.apply(volumes * u) / volumes
error = np.abs(u - blob(t)).max() / blob(t).max()
print(f"{u.size} particles, error {error:.1e} of the peak")
print(f"the total changes by {abs(volumes @ u / total - 1.0):.0e}")

figure, axes = plt.subplots(figsize=(4.5, 3.6))
shown = axes.scatter(*points.T, c=u, s=3, rasterized=True)
axes.set(xlabel="x", ylabel="y", aspect="equal", xlim=(-3, 3), ylim=(-3, 3))
figure.colorbar(shown, label=f"u at t = {t:g}")
figure.savefig("scattered.svg", bbox_inches="tight")
