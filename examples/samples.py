"""# From measured samples to a solution

Displacements of particles, measured at one time, determine alpha and the diffusivity: their characteristic function phi
is exp(-D t |k|^alpha), so log(-log |phi|) is a straight line in log k. The density at any later time follows from
these. Here the samples are drawn from a stable law, so the right answer is known.
"""

import matplotlib.pyplot as plt
import numpy as np
from scipy.stats import levy_stable

import fracparticles as fp

alpha, diffusivity, t = 1.6, 0.3, 2.0
rng = np.random.default_rng(0)
scale = (diffusivity * t) ** (1.0 / alpha)
measured = levy_stable.rvs(alpha, 0.0, scale=scale, size=20_000, random_state=rng)

k = np.geomspace(0.3, 1.5, 20) / np.median(np.abs(measured))
phi = np.abs(np.exp(1j * k[:, None] * measured).mean(axis=1))
slope, intercept = np.polyfit(np.log(k), np.log(-np.log(phi)), 1)
found, found_diffusivity = slope, np.exp(intercept) / t
print(f"alpha = {found:.3f} (drawn from {alpha}), D = {found_diffusivity:.3f} ({diffusivity})")

later = 10.0
x = np.linspace(-20.0, 20.0, 401)
predicted = fp.green(x, found_diffusivity * later, found)
scale = (diffusivity * later) ** (1.0 / alpha)
check = levy_stable.rvs(alpha, 0.0, scale=scale, size=20_000, random_state=rng)
share = np.mean(np.abs(check) < 5.0)
expected = np.trapezoid(predicted[np.abs(x) <= 5.0], dx=0.1)
print(f"share of |x| < 5 at t = {later:g}: {expected:.3f} predicted, {share:.3f} drawn")

figure, axes = plt.subplots(figsize=(6, 3.5))
axes.hist(
    check, bins=np.linspace(-20, 20, 81), density=True, color="0.8", label="samples at t = 10"
)
axes.plot(x, predicted, label="predicted from those at t = 2")
axes.set(xlabel="x", ylabel="density", yscale="log", ylim=(1e-4, 1.0))
axes.legend(frameon=False, loc="upper right", fontsize="small")
figure.savefig("samples.svg", bbox_inches="tight")
