"""# Particles that move

In the diffusion velocity method each particle keeps its strength and moves with the velocity flux / u. Their paths show
how the cloud opens. The field is the sum of the particles' kernels.
"""

import matplotlib.pyplot as plt
import numpy as np

import fracparticles as fp
from fracparticles.moving.dvm import run

alpha, h, dt, steps, start = 1.5, 0.05, 1.0e-3, 500, 0.5
x = np.arange(-10.0, 10.0, h)
times, paths = [], []


def watch(t, x, strength):
    """Keep the places after a step."""
    times.append(t)
    paths.append(x)


motion = {"spacing": h, "alpha": alpha, "dt": dt, "steps": steps, "start": start}
end = run(
    x,
    fp.green(x, start, alpha),
    **motion,
    order=4,
    exterior="open",
    remeshing="none",
    observe=watch,
)
z = np.linspace(-8.0, 8.0, 321)
exact = fp.green(z, start + steps * dt, alpha)
print(f"error {np.abs(end.field(z) - exact).max() / exact.max():.1e} of the peak")
print(
    f"the strength is {end.strength.sum():.6f}, at first {h * fp.green(x, start, alpha).sum():.6f}"
)

figure, axes = plt.subplots(1, 2, figsize=(8, 3.2), layout="constrained")
axes[0].plot(np.array(paths)[:, ::10], times, color="0.4", linewidth=0.6)
axes[0].set(xlabel="place of a particle", ylabel="time t")
axes[1].plot(z, end.field(z), label="particles")
axes[1].plot(z, exact, "--", label="exact")
axes[1].set(xlabel="x", ylabel="u at the end")
axes[1].legend(frameon=False, loc="upper right")
figure.savefig("moving_particles.svg", bbox_inches="tight")
