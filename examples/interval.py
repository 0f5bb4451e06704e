"""# An interval with absorbing ends

Beyond the ends u is zero, and a jump over an end is lost. The particles are graded towards the ends, where u falls like
the power alpha/2 of the distance. Any start decays at last like the first eigenfunction, at the rate of the first
eigenvalue.
"""

import matplotlib.pyplot as plt
import numpy as np

import fracparticles as fp

figure, axes = plt.subplots(1, 2, figsize=(8, 3.2), layout="constrained")
for alpha in (1.2, 1.5, 1.8):
    interval = fp.Interval(alpha=alpha, particles=200)
    rate = interval.eigenvalues(1)[0]
    times = np.linspace(0.0, 1.5, 31)
    masses, u = [], 1.0 - interval.x**2
    for _ in times:
        masses.append(interval.volumes @ u)
        u = interval.evolve(u, times[1])
    seen = np.log(masses[-2] / masses[-1]) / times[1]
    print(f"alpha = {alpha}: eigenvalue {rate:.6f}, rate of decay at the end {seen:.6f}")
    axes[0].semilogy(times, masses, label=rf"$\alpha$ = {alpha}")
    axes[1].plot(interval.x, u / u.max())
axes[0].set(xlabel="time t", ylabel="mass on the interval")
axes[0].legend(frameon=False)
axes[1].set(xlabel="x", ylabel="shape at t = 1.5")
figure.savefig("interval.svg", bbox_inches="tight")
