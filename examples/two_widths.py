"""# Two widths at once

One blob is a hundred times narrower than the other. A lattice that resolves the narrow one and holds the wide one has
some hundred thousand points. Particles placed where the solution bends need a few hundred.
"""

import matplotlib.pyplot as plt

import fracparticles as fp

alpha = 1.5


def exact(x, t):
    """Return the solution, a sum of two fundamental solutions."""
    return fp.green(x, 0.01**alpha + t, alpha) + fp.green(x - 50.0, 1.0 + t, alpha)


figure, axes = plt.subplots(figsize=(6, 3.2))
found = fp.follow(
    lambda x: exact(x, 0.0),
    [1.0e-3, 1.0e-2, 1.0e-1],
    alpha=alpha,
    window=(-10.0, 60.0),
    where=[-0.01, 0.0, 0.01],
)
for t, state in zip((1.0e-3, 1.0e-2, 1.0e-1), found, strict=True):
    x, u = state.particles.x, state.u
    error = abs(u - exact(x, t)).max() / u.max()
    print(f"t = {t:g}: {x.size} particles, error {error:.1e} of the peak")
    axes.plot(x, u, ".-", markersize=2, linewidth=0.6, label=f"t = {t:g}")
axes.set(xlabel="x", ylabel="u", yscale="log", xlim=(-10.0, 60.0), ylim=(1e-6, 50.0))
axes.legend(frameon=False)
figure.savefig("two_widths.svg", bbox_inches="tight")
