"""A picture of a run: u against x, with a line for each output time, or a map of the last output in the plane.

For a run from the fundamental solution the exact solution is drawn, too, dashed. The axes have the units of the file.
"""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
from cyclopts import Parameter

from fracparticles.errors import FracparticlesError, InvalidInput, spelled
from fracparticles.files import replaceable, replacing
from fracparticles.run.case import FUNDAMENTAL, Case
from fracparticles.run.dataset import read_run
from fracparticles.special.stable import green

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["draw", "plot"]

_KINDS = (".png", ".svg", ".pdf")
_SIZE = (6.0, 4.5)  # inches
_EXACT: dict[str, Any] = {"linestyle": "--", "color": "0.4", "linewidth": 1.0}


def plot(
    file: str,
    *,
    output: Annotated[str | None, Parameter(alias="-o")] = None,
    log: Annotated[bool, Parameter(negative="")] = False,
) -> None:
    """Draw the strengths of a run and print the path of the picture.

    Parameters
    ----------
    file : str
        A file that `fracparticles solve` or `fp.write` wrote.
    output : str
        The picture to write, .png, .svg or .pdf; without it the name of the run, as .png.
    log : bool
        A logarithmic axis for u.
    """
    target = Path(file).with_suffix(".png") if output is None else Path(output)
    kind = target.suffix.lower()
    if kind not in _KINDS:
        kinds = f"a file that ends in {spelled(_KINDS)}"
        raise InvalidInput("output", str(target), kinds, "Give such a name.")
    replaceable(target, "output")
    if find_spec("matplotlib") is None:
        raise FracparticlesError(
            "plot needs matplotlib, which is not installed: pip install matplotlib"
        )
    run = read_run(file)
    figure = draw(run, log=log)
    with replacing(target) as temporary:
        figure.savefig(temporary, dpi=150, bbox_inches="tight", format=kind[1:])
    print(target)


def draw(run: xr.Dataset, *, log: bool = False) -> Any:
    """Return a Matplotlib figure of a run.

    Raises
    ------
    InvalidInput
        If the run holds no strengths.
    """
    name = next((name for name in ("u", "u_axis") if name in run), None)
    if name is None:
        held = "a run that holds its strengths"
        raise InvalidInput("file", "metrics only", held, "Run the case with --store field.")
    u = run[name]
    outputs = u if "t" in u.dims else u.expand_dims(t=[float(run.t_final)])
    drawn = _map(outputs[-1], log) if outputs.ndim > 2 else _lines(outputs, _known(run), log)
    drawn.axes.set_title(run.attrs.get("title", ""), fontsize=9, wrap=True)
    return drawn.figure


def _known(run: xr.Dataset) -> Case | None:
    """The case of a run from the fundamental solution, whose exact solution is known."""
    case = Case.from_json(run.attrs["case"]) if "case" in run.attrs else None
    return case if case is not None and case.initial == FUNDAMENTAL else None


def _lines(outputs: xr.DataArray, known: Case | None, log: bool) -> Any:
    """Draw a line for each output time, and the exact one if it is known; on a logarithmic axis positive u only."""
    where: dict[str, Any] = {"figsize": _SIZE}
    for u in outputs.where(outputs > 0.0) if log else outputs:
        time = float(u.t)
        (drawn,) = u.plot(x="x", label=f"t = {time:g}", **where)
        where = {"ax": drawn.axes}
        if known is not None:
            exact = green(u.x.values, known.diffusivity * time, known.alpha, known.dim)
            drawn.axes.plot(u.x.values, exact, **_EXACT)
    if known is not None:
        drawn.axes.plot([], [], label="exact", **_EXACT)
    if log:
        drawn.axes.set_yscale("log")
    drawn.axes.legend(frameon=False)
    return drawn


def _map(u: xr.DataArray, log: bool) -> Any:
    """Draw a map of u in the plane; in space it is the middle layer."""
    middle = u if "z" not in u.dims else u.sel(z=0.0, method="nearest")
    if log:
        middle = middle.copy(data=np.log10(middle.where(middle > 0.0))).assign_attrs(
            long_name="log10 u"
        )
    drawn: Any = middle.plot.pcolormesh(x="x", y="y", figsize=_SIZE)
    units = f" [{u.x.attrs['units']}]" if "units" in u.x.attrs else ""
    drawn.axes.set(aspect="equal", xlabel=f"x{units}", ylabel=f"y{units}")
    return drawn
