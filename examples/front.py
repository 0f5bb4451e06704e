"""# A front that accelerates

Fisher's equation with fractional diffusion, u_t = div grad^beta u + u (1 - u). With alpha = 2 a front has a constant
speed. With long jumps it accelerates: the place where u is one half grows like exp(t / (1 + alpha)).
"""

import matplotlib.pyplot as plt
import numpy as np

import fracparticles as fp

alpha = 1.5
problem = fp.Problem(
    alpha=alpha,
    source="u*(1 - u)",
    half_width=1000.0,
    spacing=0.25,
    times=[4.0, 6.0, 8.0, 10.0],
)
run = fp.solve_problem(problem, lambda x: np.exp(-(x**2)))

figure, axes = plt.subplots(figsize=(6, 3.2))
front = []
for u in run.u:
    axes.plot(u.x, u, label=f"t = {float(u.t):g}")
    front.append(float(u.x[u > 0.5][-1]))
rates = np.diff(np.log(front)) / np.diff(run.t)
print("fronts at", ", ".join(f"{x:.1f}" for x in front))
print("rates", ", ".join(f"{r:.3f}" for r in rates), f"tend to {1.0 / (1.0 + alpha):.3f}")
axes.set(xlabel="x", ylabel="u", xlim=(-100.0, 100.0))
axes.legend(frameon=False)
figure.savefig("front.svg", bbox_inches="tight")
