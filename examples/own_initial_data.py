"""# Your own initial data

Two blobs of tracer on a lattice of our choice, at three later times. The lattice need not contain the
tails: power laws continue the solution beyond it. The mass that leaves the lattice is accounted for.
"""

import matplotlib.pyplot as plt
import numpy as np

import fracparticles as fp

h = 0.1
x = np.arange(-30.0, 30.0, h)
u0 = 1.5 * np.exp(-((x + 4.0) ** 2)) + np.exp(-(((x - 3.0) / 2.0) ** 2))
print(f"at first the mass is {h * u0.sum():.4f}")

figure, axes = plt.subplots(figsize=(7, 3.5))
axes.plot(x, u0, color="0.6", label="t = 0")
for t in (0.5, 2.0, 5.0):
    u = fp.evolve(u0, h, alpha=1.5, time=t)
    print(
        f"t = {t:g}: {h * u.sum():.4f} is on the lattice, {h * (u0.sum() - u.sum()):.4f} has left it"
    )
    axes.plot(x, u, label=f"t = {t:g}")
axes.set(xlabel="x", ylabel="u", xlim=(-15, 15))
axes.legend(frameon=False)
figure.savefig("own_initial_data.svg", bbox_inches="tight")
