"""# A fractional derivative by smoothed particles

The Caputo derivative of sin(x) of order 1/2 on [0, 10], from the values of the sine at particles, beside the closed
form. With 26 particles a warning says how wrong the result is, and where.
"""

import matplotlib.pyplot as plt
import numpy as np

from fracparticles.sph import ParticleLine, caputo_derivative
from fracparticles.sph.closed_forms import Sine
from fracparticles.sph.norms import relative_l2

sine, order = Sine(1.0), 0.5
figure, axes = plt.subplots(figsize=(6, 3.2))
for count in (26, 101, 401):
    line = ParticleLine(0.0, 10.0, count)
    ours = caputo_derivative(line, np.sin(line.x_all), order).real
    exact = sine.caputo(line.x, order)
    print(f"{count} particles: relative error {relative_l2(exact, ours):.1e}")
    axes.plot(line.x, ours, label=f"{count} particles")
axes.plot(line.x, exact, "--", color="black", linewidth=0.8, label="closed form")
axes.set(xlabel="x", ylabel="derivative of order 1/2")
axes.legend(frameon=False, loc="upper left", bbox_to_anchor=(1.0, 1.0))
figure.savefig("sph.svg", bbox_inches="tight")
