"""What Sec. 4.2 concludes from Figs. 3a, 4a and 5a, all beta together."""

from collections.abc import Iterator
from itertools import pairwise

import pandas as pd

from fracparticles.run.orders import observed_order
from fracparticles.special.stable import mean_radius
from fracstudy.findings import Finding, measured
from fracstudy.inputs import Inputs, Result
from fracstudy.orders import orders_of

_KEY = ["scheme", "order", "beta"]
_NAMES = {
    "error, truncated": "truncated",
    "error, open exterior": "open",
    "truncation error, predicted": "predicted",
}


def study(inputs: Inputs) -> Result:
    """Give slopes in C, plateaus and variations of the tables of the three figures, and what Sec. 4.2 says of them."""
    errors = pd.concat(inputs.tables.values(), ignore_index=True).rename(columns=_NAMES)
    parts = errors.sort_values("C").groupby(_KEY)
    summary = pd.DataFrame(_summary(part, *key) for key, part in parts)
    key = ["beta", "scheme", "order", "C"]
    series = errors.melt(id_vars=key, value_vars=list(_NAMES.values())).dropna()
    errors = errors.sort_values("C").set_index(_KEY)
    findings = [*_direct(errors), *_exchange(errors, summary.set_index(_KEY))]
    return Result(summary, findings, series)


def _summary(part: pd.DataFrame, scheme: str, order: str, beta: float) -> dict[str, object]:
    c, e = part["C"].to_numpy(), part["truncated"].to_numpy()
    slopes = observed_order(c[::-1], e[::-1])[::-1]
    beyond = part[part["C"] > 20.0]
    floor = float(part["open"].iloc[-1])
    row: dict[str, object] = {
        "scheme": scheme,
        "order": order,
        "beta": beta,
        "first slope in C": slopes[0],
        "last slope in C": slopes[-1],
        "- alpha": -(1.0 + beta),
        "error at the least C": e[0],
        "error at the greatest C": e[-1],
        "open error": floor,
        "variation for C > 20": float(beyond["truncated"].max() / beyond["truncated"].min() - 1.0),
        "truncated / open for C > 20": float((beyond["truncated"] / beyond["open"]).max()),
    }
    if part["predicted"].notna().any():
        # C at which the predicted truncation error has fallen to the discretisation error.
        ratio = part["predicted"].iloc[-1] / floor
        row["C of the plateau"] = c[-1] * ratio ** (1.0 / (1.0 + beta))
    return row


def _by_beta(values: pd.Series) -> pd.Series:
    """The value at each beta over that at the next larger one, by what else the values depend on."""
    wide = values.unstack("beta").sort_index(axis=1)
    ratio = wide / wide.shift(-1, axis=1)
    names = {a: f"beta = {a:g} over {b:g}" for a, b in pairwise(wide.columns)}
    return ratio.iloc[:, :-1].rename(columns=names).stack()


def _direct(errors: pd.DataFrame) -> Iterator[Finding]:
    """DD and FPSE, L-C4."""
    direct = errors.loc[["DD", "FPSE"]]
    wide = direct[direct["C"] > 20.0]
    of_all = wide.groupby(level=_KEY)
    variation = of_all["truncated"].max() / of_all["truncated"].min() - 1.0
    for scheme in ("DD", "FPSE"):
        yield measured(f"L-C4.independent.{scheme}", variation=variation[scheme])
    share = ((wide["truncated"] - wide["open"]).abs() / wide["open"]).groupby(level=_KEY).max()
    yield measured("L-C4.dominated", share=share)
    last = direct[direct["C"] == direct["C"].max()]
    scaled = last["truncated"] / last["h"] ** orders_of(last.index)
    at_equal_h = {"at equal h, error / h^p": {"ratio": _by_beta(scaled)}}
    yield measured("L-C4.grows", others=at_equal_h, ratio=_by_beta(last["truncated"]))

    def fpse_over_dd(kind: str) -> pd.Series:
        of_both = wide.set_index("C", append=True)[kind]
        return (of_both["FPSE"] / of_both["DD"]).groupby(level=["order", "beta"]).min()

    without = {"the open exterior": {"ratio": fpse_over_dd("open")}}
    yield measured("L-C4.dd_better", others=without, ratio=fpse_over_dd("truncated"))


def _exchange(errors: pd.DataFrame, summary: pd.DataFrame) -> Iterator[Finding]:
    """KPSE and GPSE, L-C5 and L-C6."""
    first, plateau = summary["first slope in C"], summary["C of the plateau"]
    before_last = errors["truncated"].groupby(level=_KEY).nth(-2)
    change = before_last / errors["truncated"].groupby(level=_KEY).last() - 1.0
    caused = errors.assign(by_it=(errors["truncated"] - errors["open"]).abs())
    caused = caused.set_index("C", append=True)
    kpse, gpse = caused.loc["KPSE"], caused.loc["GPSE"].loc["II"]
    yield measured("L-C5.falls", slope=first["KPSE"])
    yield measured("L-C5.levels_off", change=change["KPSE"])
    yield measured("L-C5.later_for_small_beta", ratio=_by_beta(plateau["KPSE"]), C=plateau["KPSE"])
    sensitive = _by_beta(kpse["by_it"]).groupby(level=[0, 2]).min()
    yield measured("L-C5.sensitive", ratio=sensitive)
    radius = pd.Series({b: mean_radius(1.0 + b) for b in sorted(gpse.index.unique("beta"))})
    ratio = {f"beta = {a:g} over {b:g}": radius[a] / radius[b] for a, b in pairwise(radius.index)}
    yield measured("L-C5.length_scales", ratio=ratio)
    away = (first - summary["- alpha"]).abs()
    for scheme in ("KPSE", "GPSE"):
        yield measured(f"L-C5.power.{scheme}", away=away[scheme], slope=first[scheme])
    four = kpse.loc["IV"]
    off = {"KPSE IV": four["truncated"] / four["predicted"]}
    off["GPSE"] = gpse["truncated"] / gpse["predicted"]
    tail = {name: (ratio - 1.0).abs().max() for name, ratio in off.items()}
    twins = (gpse["truncated"] / four["truncated"] - 1.0).abs()
    gain = (four["truncated"] / four["open"]).min()
    yield measured("L-C5.origin", tail=tail, step=twins.max(), gain=gain)
    by_c = _by_beta(gpse["truncated"])
    c = by_c.index.get_level_values("C")
    yield measured("L-C6.small_domains", ratio=by_c[c <= 30.0].groupby(level=1).min())
    yield measured("L-C6.levels_off", change=change["GPSE"].loc["II"])
    yield measured("L-C6.higher_for_low_beta", ratio=by_c[c > 30.0].groupby(level=1).min())
    yield measured("L-C6.different_mechanism", difference=twins.max())
