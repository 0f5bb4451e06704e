"""# Markers that part

The marker method moves particles of constant weight with the velocity -F_x / F, where F is the sum of their shape
functions. A blob widens because its markers part. The solution is a Gaussian.
"""

import matplotlib.pyplot as plt
import numpy as np

from fracparticles.markers import SHAPES, Gaussian, MarkerVelocity, run, uniform

blob, dt = Gaussian(), 1.0e-3
x, weights = uniform(blob.value, (-2.5, 2.5), 161)
velocity = MarkerVelocity(SHAPES["S8"], epsilon=0.15)

figure, axes = plt.subplots(figsize=(6, 3.2))
z = np.linspace(-2.0, 2.0, 401)
for row, steps in enumerate((1, 50, 200)):
    end = run(x, weights, velocity, dt=dt, steps=steps)
    exact = blob.value(z, steps * dt)
    error = np.abs(end.field(z) - exact).max() / exact.max()
    print(f"t = {steps * dt:g}: error {error:.1e} of the peak, markers to {end.x[-1]:.2f}")
    (line,) = axes.plot(z, end.field(z), label=f"t = {steps * dt:g}")
    axes.plot(z, exact, "--", color="black", linewidth=0.6)
    axes.plot(end.x[::8], np.full(21, -0.04 * (row + 1)), "|", color=line.get_color())
axes.set(xlabel="x", ylabel="F; exact: dashed; markers: ticks", xlim=(-4.0, 4.0))
axes.legend(frameon=False)
figure.savefig("markers.svg", bbox_inches="tight")
