"""# A convergence study in thirty lines

KPSE with kernels of order 2, 4 and 6 at four spacings. Each run is a data set, and together they form a cube whose axes
are the parameters. The order is the slope between two spacings.
"""

import matplotlib.pyplot as plt
import numpy as np
import xarray as xr

import fracparticles as fp

orders, spacings = [2, 4, 6], [0.4, 0.2, 0.1, 0.05]
common = {"scheme": "KPSE", "beta": 0.5, "truncation": 20.0, "store": "metrics"}
common |= {"integrator": "exponential", "exterior": "open", "far_terms": 3}
runs = [[fp.solve(fp.Case(order=order, spacing=h, **common)) for h in spacings] for order in orders]
cube = xr.combine_nested(
    runs,
    ["order", "particle_spacing"],
    coords="different",
    compat="no_conflicts",
    combine_attrs="drop",
)
errors = cube.relative_l1_error
slopes = np.log2(errors.shift(particle_spacing=1) / errors)
print(errors.to_pandas().map("{:.1e}".format))
print(slopes.isel(particle_spacing=slice(1, None)).to_pandas().round(2))

figure, axes = plt.subplots(figsize=(5, 3.5))
errors.plot.line(x="particle_spacing", hue="order", xscale="log", yscale="log", marker="o", ax=axes)
axes.set(xlabel="particle spacing h", ylabel="relative error, Eq. (48)", title="")
figure.savefig("convergence.svg", bbox_inches="tight")
