"""# A medium of two layers

The diffusivity falls from 2 to 0.1 across x = 0, so a blob that starts there spreads to the left and stays on the
right. `fp.Problem` takes coefficients as text or as functions, chooses its own steps, and says what it may be off by.
"""

import matplotlib.pyplot as plt
import numpy as np

import fracparticles as fp

problem = fp.Problem(
    alpha=1.6,
    diffusivity="1.05 - 0.95*tanh(2*x)",
    half_width=40.0,
    spacing=0.1,
    times=[0.5, 2.0, 5.0],
)
run = fp.solve_problem(problem, lambda x: np.exp(-(x**2)))
print(f"{int(run.evaluations)} evaluations of the operator")
print(f"estimated error: {float(run.space_error.max()):.0e} of the greatest u")

figure, axes = plt.subplots(figsize=(6, 3.2))
for u in run.u:
    left = float(u.where(u.x < 0.0).sum() / u.sum())
    print(f"t = {float(u.t):g}: {left:.1%} of the mass is on the left")
    axes.plot(u.x, u, label=f"t = {float(u.t):g}")
axes.axvline(0.0, color="0.8", linewidth=0.8, zorder=0)
axes.set(xlabel="x", ylabel="u", xlim=(-12.0, 12.0))
axes.legend(frameon=False)
figure.savefig("layers.svg", bbox_inches="tight")
