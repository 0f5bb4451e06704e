"""The commands of the command line, see `cli`. Heavy modules are imported by the commands that need them."""

from __future__ import annotations

from importlib.metadata import entry_points
from importlib.util import find_spec

from cyclopts import App

from fracparticles import __version__

__all__ = ["app"]

app = App(
    name="fracparticles",
    help="Particle methods for space-fractional diffusion.",
    version=__version__,
    suppress_keyboard_interrupt=False,  # `main` reports it
)
# Commands by their addresses: their flags are fields of Case, whose import takes the whole core.
_COMMANDS = {
    "commands:solve": "Run a case and write its file.",
    "picture:plot": "Draw the strengths of a run.",
    "compare:compare": "Print in what two runs differ.",
    "commands:limit": "Print the stability limit a of Eq. (55), and with --spacing the largest stable time step.",
}
for _place, _help in _COMMANDS.items():
    app.command(f"fracparticles.command_line.{_place}", name=_place.split(":")[1], help=_help)
# The commands of other installed packages, such as the study.
for _entry in entry_points(group="fracparticles.commands"):
    if find_spec(_entry.module.split(".")[0]) is not None:
        app.command(_entry.load(), name=_entry.name)
app.register_install_completion_command(
    help="Install completion for bash, zsh or fish, and say where."
)


@app.command
def show(file: str) -> None:
    """Print a summary of a run: parameters, error, masses, operator applications.

    Parameters
    ----------
    file : str
        A file that `fracparticles solve` or `fp.write` wrote.
    """
    from fracparticles.run.dataset import read_run

    run = read_run(file)
    scalars = [*run.coords.values(), *run.data_vars.values()]
    rows = [
        (str(scalar.name), _shown(scalar.item()), scalar.attrs.get("long_name", ""))
        for scalar in scalars
        if scalar.ndim == 0
    ]
    rows += [
        (str(along.name), " ".join(map(_shown, along.values)), along.attrs.get("long_name", ""))
        for along in scalars
        if along.dims == ("t",)
    ]
    rows += [(name, str(run.attrs.get(name, "")), "") for name in ("initial_data", "source")]
    for name in ("u", "u_axis", "u_diagonal"):
        if name in run:
            size = " x ".join(map(str, run[name].shape))
            extent = f"{size} values, x = {run.x.values[0]:.9g} .. {run.x.values[-1]:.9g}"
            rows.append((name, extent, run[name].attrs.get("long_name", "")))
    first = max(len(name) for name, _, _ in rows)
    second = max(len(value) for _, value, meaning in rows if meaning)
    print(run.attrs.get("title", file))
    for name, value, meaning in rows:
        print(f"  {name:{first}}  {value:{second}}  {meaning}".rstrip())


def _shown(value: object) -> str:
    return f"{value:.9g}" if isinstance(value, float) else str(value)
