"""The three variants that the paper rejects without showing why: DPSE, scheme (29), the cut-off Riesz potential."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from fracparticles import integrators
from fracparticles.case import Case
from fracparticles.claims import Finding
from fracparticles.dataset import read_run
from fracparticles.errors import NonFiniteSolution
from fracparticles.kernels import kernel
from fracparticles.schemes import SCHEMES, Setting, dpse, riesz
from fracparticles.solver import compute, initial_strengths
from fracparticles.special.stable import central_mass, green, mean_radius
from fracparticles.spectrum import dense_matrix
from fracparticles.studies.common import Inputs, Result, observed_order, statement
from fracparticles.sums import BandedConvolution, valid_convolution

__all__ = ["exact_flux", "rejected_29", "rejected_dpse", "rejected_riesz"]


def exact_flux(x: np.ndarray, time: float, alpha: float) -> np.ndarray:
    """Q = x u / (alpha t), the flux of the fundamental solution.

    u = t^(-1/alpha) L(x / t^(1/alpha)) gives u_t = -(x u)_x / (alpha t), and u_t + Q_x = 0 with Q(0) = 0.
    """
    return x * green(x, time, alpha) / (alpha * time)


# --- DPSE -----------------------------------------------------------------------------------------------------------

_LARGE = 10.0  # an error this many times the exact value is large
_PREDICTED = (
    0.2  # relative; what (A.2) and the tail of the kernel leave out is of the order D^(-alpha)
)
_LAYER = 0.1  # relative error that ends the layer at the edge


def rejected_dpse(inputs: Inputs) -> Result:
    """DPSE at the ends of the lattice: the solution, the rate of change, and where its error comes from.

    The second sum of DPSE runs over the particles present: at x = D it is one-sided and sees the slope of the
    potential v. The kernel's tail, kappa^beta ~ c |r|^(-beta), sets that slope: v'(D) = -M beta c D^(-alpha), M the
    total strength. With c_m the weights of (16), the error of the rate of change is then

        e = M beta c D^(-alpha) (1 / h) sum_{m >= 1} m c_m.

    The errors are called large if u is more than ten times the exact solution at |x| = D for every run of DPSE. The
    slow decay is called their cause if the error of the rate agrees with e to 20 % and falls at least tenfold when v
    is also computed at the particles next to the ends ("a different particle grid to represent v").
    """
    runs = inputs.scalars
    rows, series = [], []
    for run in runs.itertuples():
        data = read_run(run.run)
        x, u = data["x"].values, data["u"].values
        exact = np.asarray(green(x, run.t_final, 1.0 + run.beta))
        relative = np.abs(u - exact) / exact
        distance = (run.half_width - x) / (run.overlap * run.particle_spacing)
        row = {
            "scheme": run.scheme,
            "beta": run.beta,
            "C": run.truncation,
            "u / exact at |x| = D": u[-1] / exact[-1],
            "|error| at |x| = D / peak": abs(u[-1] - exact[-1]) / exact.max(),
            "error above 10 % within, in ε": distance[(x > 0.0) & (relative > _LAYER)].max(
                initial=0.0
            ),
            "relative error at 0.9 D": float(np.interp(0.9 * run.half_width, x, relative)),
            "error (48)": run.relative_l1_error,
        }
        if run.scheme == "DPSE":
            row |= _rate_at_the_edge(run)
        rows.append(row)
        if np.isclose(run.beta, inputs.parameters["beta"]) and np.isclose(
            run.truncation, inputs.parameters["truncation"]
        ):
            series.append(_edge(run.scheme, x, u, exact, distance))
    table = pd.DataFrame(rows).sort_values(["beta", "C", "scheme"])
    findings = _dpse_findings(table, list(runs["run"]))
    return Result(table, findings, pd.concat(series, ignore_index=True))


def _rate_at_the_edge(run: Any) -> dict[str, float]:
    """du/dt of the exact initial data at x = D less its exact value, four ways."""
    alpha, n = 1.0 + run.beta, round(run.half_width / run.particle_spacing)
    h, s, order = run.particle_spacing, run.overlap, int(run.order)
    setting = Setting(n=n, spacing=h, alpha=alpha, order=order, overlap=s)
    x = np.arange(-n, n + 1) * h
    u = np.asarray(green(x, run.t_initial, alpha))
    # u_t = -Q_x at the end, from the exact flux one spacing to either side
    sides = exact_flux(run.half_width + np.array([-h, h]), run.t_initial, alpha)
    exact = -(sides[1] - sides[0]) / (2.0 * h)

    reach = BandedConvolution.reach(s, order)
    c = dpse.laplacian_weights(np.arange(reach + 1.0), alpha, order, s)
    mass = central_mass(run.half_width, run.t_initial, alpha)
    slope = mass * run.beta * riesz.potential_constant(alpha) * run.half_width**-alpha
    return {
        "error of du/dt at D": SCHEMES["DPSE"].operator(setting).apply(u)[-1] - exact,
        "the same, from the tail of κ": slope / h * (np.arange(reach + 1.0) @ c),
        "the same, v continued": _rate_with_continued_potential(setting, u, c) - exact,
        "the same, FPSE": SCHEMES["FPSE"].operator(setting).apply(u)[-1] - exact,
    }


def _rate_with_continued_potential(setting: Setting, u: np.ndarray, c: np.ndarray) -> float:
    """(16) at x = D with v of (13) on `reach` particles beyond the end as well."""
    reach, h = c.size - 1, setting.spacing
    offsets = np.arange(-2 * setting.n - reach, 2 * setting.n + reach + 1.0)
    b = dpse.potential_weights(offsets, setting.alpha, setting.order, setting.overlap)
    v = h ** (2.0 - setting.alpha) * valid_convolution(u, b)[-2 * reach - 1 :]
    stencil = np.concatenate([c[:0:-1], c])
    return float(stencil @ (v - v[reach])) / h**2


def _edge(
    scheme: str, x: np.ndarray, u: np.ndarray, exact: np.ndarray, distance: np.ndarray
) -> pd.DataFrame:
    """The profile of the last thirty smoothing lengths, and the relative error at 150 points of log distance."""
    last = np.flatnonzero((distance <= 30.0) & (x > 0.0))
    wanted = np.geomspace(distance[-2], distance[x > 0.0].max(), 150)
    spread = np.unique(x.size - 1 - np.searchsorted(distance[::-1], wanted))
    relative = np.abs(u - exact) / exact
    parts = [
        {"panel": "profile", "x": distance[last], "y": u[last], "exact": exact[last]},
        {"panel": "relative", "x": distance[spread], "y": relative[spread], "exact": exact[spread]},
    ]
    return pd.concat([pd.DataFrame(part).assign(scheme=scheme) for part in parts])


def _dpse_findings(table: pd.DataFrame, files: list[str]) -> list[Finding]:
    ours = table[table["scheme"] == "DPSE"]
    kpse = table[table["scheme"] == "KPSE"]
    ratio, other = ours["u / exact at |x| = D"], kpse["u / exact at |x| = D"]
    error, tail = ours["error of du/dt at D"], ours["the same, from the tail of κ"]
    gain = (error / ours["the same, v continued"]).abs()
    agreement = (tail / error - 1.0).abs()
    fpse_deviation = (ours["the same, FPSE"] / error - 1.0).abs()
    return [
        statement(
            "L-C14.edges",
            bool((ratio > _LARGE).all()),
            f"At |x| = D, u of DPSE is {ratio.min():.3g} to {ratio.max():.3g} times the exact solution, that of KPSE "
            f"{other.min():.4g} to {other.max():.4g} times.",
            "The errors at the edge stay below ten times the solution there.",
            files,
        ),
        statement(
            "L-C14.cause",
            bool((agreement < _PREDICTED).all() and (gain > 10.0).all()),
            f"The tail of kappa predicts the error of du/dt at the edge to {100.0 * agreement.max():.2g} % at worst; "
            f"with v computed at the particles next to the ends as well it falls {gain.min():.3g} to {gain.max():.3g} "
            f"times. FPSE, whose F is the gradient of kappa, has the same to {100.0 * fpse_deviation.max():.2g} %.",
            "The tail of the kernel does not account for the error at the edge.",
            files,
        ),
    ]


# --- Scheme (29) ----------------------------------------------------------------------------------------------------

_NODES = np.linspace(0.0, 20.0, 4001)  # r; G is smooth on the scale 1
_OVERLAP = 2.0


def rejected_29(inputs: Inputs) -> Result:
    """Scheme (29): the kernel, the spectrum, the growth and the errors.

    On a bounded lattice -sum_j G_(i-j) > 0 stays on the diagonal near the ends, where half of the negative middle of G
    is left alone with the positive tail. The greatest eigenvalue is a number of the kernel alone, lambda h^alpha / D,
    and its mode a layer a few epsilon thick: in time T the solution grows by exp(lambda T), without bound as h -> 0.

    The kernel statement holds if G(0) < 0, G changes sign and is not monotonic, at every beta. The errors are called
    large if |u| is more than ten times the exact solution at |x| = D at the smallest h of every beta. The instability
    is shown if the greatest eigenvalue is positive at every beta and the growth of the runs has its rate to 1 %.
    """
    runs = inputs.scalars
    betas = sorted(runs["beta"].unique())
    size = int(inputs.parameters["dense"])
    spectra = {beta: _spectrum("PSE29", beta, size) for beta in betas}
    beta = float(inputs.parameters["beta"])
    history = _history(beta, float(spectra[beta][-1]), **inputs.parameters["history"])
    table = _table_29(runs, {b: float(eigenvalues[-1]) for b, eigenvalues in spectra.items()})
    kernels = {b: np.asarray(kernel("G", _NODES, 1.0 + b)) for b in betas}
    blow_up = _blow_up(beta, float(spectra[beta][-1]))
    findings = _findings_29(table, kernels, spectra, history, blow_up, list(runs["run"]))
    near = _NODES <= 4.0
    parts = [
        pd.DataFrame({"panel": "kernel", "series": f"{b:g}", "x": _NODES[near], "y": G[near]})
        for b, G in kernels.items()
    ]
    for name in ("PSE29", "DD"):
        eigenvalues = spectra[beta] if name == "PSE29" else _spectrum(name, beta, size)
        rank = np.arange(1, size + 1) / size
        parts.append(
            pd.DataFrame({"panel": "spectrum", "series": name, "x": rank, "y": eigenvalues})
        )
    every = max(1, len(history) // 400)
    parts.append(history.iloc[::every].assign(panel="history"))
    return Result(table, findings, pd.concat(parts, ignore_index=True))


def _spectrum(name: str, beta: float, size: int) -> np.ndarray:
    """The eigenvalues of A h^alpha / D, ascending; A is symmetric."""
    setting = Setting(n=size // 2, spacing=1.0, alpha=1.0 + beta, overlap=_OVERLAP)
    return np.linalg.eigvalsh(dense_matrix(SCHEMES[name].operator(setting)))


def _history(
    beta: float, growth: float, half_width: float, spacing: list[float], foldings: float
) -> pd.DataFrame:
    """|u(D, t)| of RK2 in time until it must have grown by exp(foldings), and the predicted growth.

    The step is a fiftieth of the growth time: p(lambda dt) is then exp(lambda dt) to 1e-6.
    """
    parts = []
    for h in spacing:
        n = round(half_width / h)
        setting = Setting(n=n, spacing=half_width / n, alpha=1.0 + beta, overlap=_OVERLAP)
        rate, steps = growth * setting.rate, round(50.0 * foldings)
        operator = SCHEMES["PSE29"].operator(setting)
        u = np.asarray(green(np.arange(-n, n + 1) * setting.spacing, 0.5, 1.0 + beta))
        edge = [u[-1]]
        for _ in range(steps):
            u = integrators.step(operator, integrators.STEP_POLYNOMIALS["rk2"], 0.02 / rate, 1, u)
            edge.append(u[-1])
        time = 0.5 + 0.02 / rate * np.arange(steps + 1)
        y = np.abs(edge)
        predicted = y[-1] * np.exp(rate * (time - time[-1]))
        late = time > time[0] + 0.75 * (time[-1] - time[0])
        measured = np.polyfit(time[late], np.log(y[late]), 1)[0]
        parts.append(
            pd.DataFrame({"series": f"{h:.3g}", "x": time, "y": y, "predicted": predicted}).assign(
                deviation=measured / rate - 1.0
            )
        )
    return pd.concat(parts, ignore_index=True)


def _blow_up(beta: float, growth: float) -> dict[str, Any]:
    """Run (29) on a small lattice until it overflows: the step predicted from the growing modes, and the message."""
    case = Case(
        scheme="PSE29", beta=beta, half_width=10.0, spacing=0.2, overlap=_OVERLAP, dt=0.02, t_final=1000.0,
        evaluation="stepping", store="metrics",
    )  # fmt: skip
    matrix = dense_matrix(SCHEMES["PSE29"].operator(case.setting))
    values, modes = np.linalg.eigh(matrix)
    amplitudes = modes.T @ initial_strengths(case)[0]
    factor = np.log(integrators.STEP_POLYNOMIALS["rk2"](values * case.time_step))
    largest = np.log(np.abs(amplitudes) * np.abs(modes).max(axis=0) + np.finfo(float).tiny)
    growing = factor > 0.0
    steps = (np.log(np.finfo(float).max) - largest[growing]) / factor[growing]
    try:
        compute(case)
    except NonFiniteSolution as error:
        return {"predicted": float(steps.min()), "message": str(error)}
    return {"predicted": float(steps.min()), "message": ""}


def _table_29(runs: pd.DataFrame, greatest: dict[float, float]) -> pd.DataFrame:
    rows = []
    for (beta, h), pair in runs.groupby(["beta", "particle_spacing"]):
        pair = pair.set_index("scheme")
        run = pair.loc["PSE29"]
        u = read_run(run["run"])["u"].values
        exact = float(green(run["half_width"], run["t_final"], 1.0 + beta))
        rate = greatest[beta] * run["diffusivity"] / h ** (1.0 + beta)
        ours, dd = pair["relative_l1_error"][["PSE29", "DD"]]
        rows.append(
            {
                "beta": beta,
                "h": h,
                "greatest eigenvalue, λ h^α / D": greatest[beta],
                "λ": rate,
                "log10 of the growth exp(λ T)": rate
                * (run["t_final"] - run["t_initial"])
                / np.log(10.0),
                "|u| / exact at |x| = D": abs(u[-1]) / exact,
                "error (48) of (29)": ours,
                "error (48) of DD": dd,
                "ratio": ours / dd,
            }
        )
    return pd.DataFrame(rows).sort_values(["beta", "h"], ascending=[True, False])


def _findings_29(
    table: pd.DataFrame,
    kernels: Mapping[float, np.ndarray],
    spectra: Mapping[float, np.ndarray],
    history: pd.DataFrame,
    blow_up: Mapping[str, Any],
    files: list[str],
) -> list[Finding]:
    origin = {beta: G[0] for beta, G in kernels.items()}
    crossing = {beta: _NODES[np.flatnonzero(np.diff(np.sign(G)))] for beta, G in kernels.items()}
    turns = {beta: int((np.diff(np.sign(np.diff(G))) != 0).sum()) for beta, G in kernels.items()}
    top = {beta: _NODES[G.argmax()] for beta, G in kernels.items()}
    finest, coarsest = (table.groupby("beta").agg(which) for which in ("last", "first"))
    greatest = {beta: eigenvalues[-1] for beta, eigenvalues in spectra.items()}
    edge = "|u| / exact at |x| = D"
    deviation = history.groupby("series")["deviation"].first().abs().max()
    return [
        statement(
            "L-C15.kernel",
            all(origin[beta] < 0.0 and crossing[beta].size and turns[beta] for beta in kernels),
            f"The kernel of (29) is G of (11): G(0) = {_by_beta(origin)}; it changes sign at r = "
            f"{_by_beta({b: c[0] for b, c in crossing.items() if c.size})} and has its maximum at r = {_by_beta(top)}.",
            "G does not have all three properties.",
        ),
        statement(
            "L-C15.errors",
            bool((finest[edge] > _LARGE).all()),
            f"At |x| = D and the smallest h, |u| over the exact solution is {_by_beta(finest[edge])}; the error (48), "
            f"over that of DD, {_by_beta(finest['ratio'])}. At the largest h the two are {_by_beta(coarsest[edge])} "
            f"and {_by_beta(coarsest['ratio'])}: the scheme diverges as h falls.",
            "Within the run the layer at the ends does not outgrow the solution at every beta.",
            files,
        ),
        statement(
            "L-C15.instability",
            all(value > 0.0 for value in greatest.values()) and bool(deviation < 0.01),
            f"The greatest eigenvalue is {_by_beta(greatest, 4)} in units of D / h^alpha; runs grow at this rate to "
            f"{100.0 * deviation:.2g} %. A run predicted to overflow at step {blow_up['predicted']:.0f} ends with: "
            f"{blow_up['message'].split(':')[1].strip() if blow_up['message'] else 'no overflow'}.",
            "The runs do not grow at the rate of a positive eigenvalue.",
        ),
    ]


def _by_beta(values: Mapping[float, float] | pd.Series, digits: int = 3) -> str:
    return ", ".join(
        f"{value:.{digits}g} (beta = {beta:g})" for beta, value in dict(values).items()
    )


# --- The regularised Riesz potential --------------------------------------------------------------------------------

_POOR = 10.0  # times the error of the flux (19)


def rejected_riesz(inputs: Inputs) -> Result:
    """The flux -v' of the potential cut off at epsilon, and of the mollified one, against Q = x u / (alpha t).

        Q_i = (1 / epsilon^alpha) sum_j V_j u_j r K(r),    r = (x_i - x_j) / epsilon,

    with K of (31), which is the flux (19), or K* of the cut-off potential. The transform of r K* differs from that of
    the exact flux by a part of the relative order (epsilon k)^(2-alpha). The flux is called poor if its relative L1
    error over |x| <= 5 R_alpha is more than ten times that of (19), at every alpha and on every lattice; worst at large
    alpha if the error grows with alpha on every lattice.
    """
    parameters = inputs.parameters
    alphas = [float(alpha) for alpha in parameters["alpha"]]
    rows = [
        _flux_errors(alpha, float(h), parameters) for alpha in alphas for h in parameters["spacing"]
    ]
    flux = pd.DataFrame(rows)
    flux["observed order, cut-off"] = _orders(flux, "error, cut-off")
    flux["observed order, (19)"] = _orders(flux, "error, (19)")
    runs = inputs.scalars.assign(
        alpha=1.0 + inputs.scalars["beta"], h=inputs.scalars["particle_spacing"]
    )
    solution = runs.pivot_table(
        index=["alpha", "h"], columns="scheme", values="relative_l1_error"
    ).reset_index()
    solution["observed order, cut-off"] = _orders(solution, "RIESZ")
    finest = flux[flux["h"] == flux["h"].min()].set_index("alpha")
    table = pd.concat(
        [
            flux.assign(of="flux").rename(columns={"error, (19)": "error, mollified (KPSE)"}),
            solution.assign(of="solution (48)").rename(
                columns={"RIESZ": "error, cut-off", "KPSE": "error, mollified (KPSE)"}
            ),
        ]
    )
    table["2 - α"] = 2.0 - table["alpha"]
    columns = [
        "of",
        "alpha",
        "h",
        "error, cut-off",
        "observed order, cut-off",
        "2 - α",
        "error, mollified (KPSE)",
    ]
    table = table[columns].sort_values(["of", "alpha", "h"], ascending=[True, True, False])
    ratio = flux["error, cut-off"] / flux["error, (19)"]
    by_lattice = flux.pivot_table(index="h", columns="alpha", values="error, cut-off")
    rises = bool((np.diff(by_lattice.to_numpy(), axis=1) > 0.0).all())
    errors = ", ".join(f"{e:.2g} (alpha = {a:g})" for a, e in finest["error, cut-off"].items())
    orders = ", ".join(f"{p:.2f}" for p in finest["observed order, cut-off"])
    others = ", ".join(f"{e:.1g}" for e in finest["error, (19)"])
    findings = [
        statement(
            "L-C16.poor",
            bool((ratio > _POOR).all()),
            f"Relative error of the flux at h = {flux['h'].min():g}: {errors}; of the flux (19): {others}. It falls "
            f"with the orders {orders}.",
            "On the coarsest lattice the flux (19) is not ten times better.",
        ),
        statement(
            "L-C16.worst_large_alpha",
            rises,
            f"Relative error of the flux at h = {flux['h'].min():g}: {errors}; it rises with alpha on every lattice."
            if rises
            else f"Relative error of the flux at h = {flux['h'].min():g}: {errors}.",
            "The error does not rise with alpha on every lattice.",
        ),
    ]
    drawn = pd.concat(
        [
            flux.assign(panel="flux", series="RIESZ", x=flux["h"], y=flux["error, cut-off"]),
            flux.assign(panel="flux", series="KPSE", x=flux["h"], y=flux["error, (19)"]),
            runs.assign(
                panel="solution", series=runs["scheme"], x=runs["h"], y=runs["relative_l1_error"]
            ),
            *_flux_profile(max(alphas), float(parameters["spacing"][-1]), parameters),
        ]
    )
    return Result(table, findings, drawn[["panel", "series", "alpha", "x", "y"]])


def _fluxes(
    alpha: float, h: float, parameters: Mapping[str, Any]
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Positions within 5 R_alpha, the exact flux, that of the cut-off potential, that of (19)."""
    n, s = round(float(parameters["half_width"]) / h), float(parameters["overlap"])
    x, time = np.arange(-n, n + 1) * h, float(parameters["time"])
    u = np.asarray(green(x, time, alpha))
    r = np.arange(-2 * n, 2 * n + 1) / s
    scale = h / (s * h) ** alpha  # V_j / epsilon^alpha
    cut_off = scale * valid_convolution(u, r * riesz.kernel_star(r, alpha))
    mollified = -scale * valid_convolution(u, np.asarray(kernel("F", r, alpha)))
    inside = np.abs(x) <= 5.0 * mean_radius(alpha)
    return x[inside], exact_flux(x, time, alpha)[inside], cut_off[inside], mollified[inside]


def _flux_errors(alpha: float, h: float, parameters: Mapping[str, Any]) -> dict[str, float]:
    _, exact, cut_off, mollified = _fluxes(alpha, h, parameters)
    size = np.abs(exact).sum()
    return {
        "alpha": alpha,
        "h": h,
        "error, cut-off": float(np.abs(cut_off - exact).sum() / size),
        "error, (19)": float(np.abs(mollified - exact).sum() / size),
    }


def _flux_profile(alpha: float, h: float, parameters: Mapping[str, Any]) -> list[pd.DataFrame]:
    x, exact, cut_off, mollified = _fluxes(alpha, h, parameters)
    shown = np.flatnonzero((x >= 0.0) & (x <= 6.0))
    shown = shown[:: max(1, shown.size // 200)]
    return [
        pd.DataFrame(
            {"panel": "profile", "series": name, "alpha": alpha, "x": x[shown], "y": y[shown]}
        )
        for name, y in (("exact", exact), ("RIESZ", cut_off), ("KPSE", mollified))
    ]


def _orders(table: pd.DataFrame, column: str) -> np.ndarray:
    """The observed order against the next larger h of the same alpha, nan at the largest."""
    out = pd.Series(np.nan, index=table.index)
    for _, part in table.groupby("alpha"):
        part = part.sort_values("h", ascending=False)
        out[part.index[1:]] = observed_order(part["h"].to_numpy(), part[column].to_numpy())
    return out.to_numpy()
