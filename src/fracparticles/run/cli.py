"""The command line: `fracparticles solve`, `show` and `limit`.

Results go to standard output, everything else to standard error, one line each. Exit status: 0 done, 1 the
machine failed (a full disk, no memory), 2 the input cannot be worked with, 3 the solution blew up, 130 interrupted.
What is heavy is imported by the command that needs it.
"""

from __future__ import annotations

import os
import sys
import warnings
from collections.abc import Sequence

from cyclopts import App, CycloptsError

from fracparticles import __version__
from fracparticles.errors import (
    FracparticlesError,
    FracparticlesWarning,
    InvalidInput,
    NonFiniteSolution,
)

__all__ = ["app", "main"]

app = App(
    name="fracparticles",
    help="Particle methods for space-fractional diffusion.",
    version=__version__,
    suppress_keyboard_interrupt=False,  # `main` reports it
)
# By their addresses: the flags are fields of Case, which takes the whole core to import.
_COMMANDS = {
    "solve": "Run a case and write its file.",
    "limit": "Print the stability limit a of Eq. (55), and with --spacing the largest stable time step.",
}
for _name, _help in _COMMANDS.items():
    app.command(f"fracparticles.run.commands:{_name}", name=_name, help=_help)


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


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line and return the exit status."""
    with warnings.catch_warnings():
        warnings.showwarning = _show_warning
        warnings.simplefilter("always", FracparticlesWarning)
        try:
            app(
                arguments,
                print_error=False,
                exit_on_error=False,
                help_on_error=False,
                verbose=False,
                result_action="return_value",
            )
            sys.stdout.flush()
        except (CycloptsError, InvalidInput) as error:
            return _fail(error, 2)
        except NonFiniteSolution as error:
            return _fail(error, 3)
        except BrokenPipeError:
            # The reader, `head` say, has gone. Nothing must be left for the interpreter to flush at exit.
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
            return 141  # 128 + SIGPIPE
        except (FracparticlesError, OSError, MemoryError) as error:
            return _fail(error, 1)
        except KeyboardInterrupt:
            return _fail("interrupted", 130)
    return 0


def _shown(value: object) -> str:
    return f"{value:.9g}" if isinstance(value, float) else str(value)


def _fail(error: object, status: int) -> int:
    message = " ".join(str(error).split()) or type(error).__name__
    print(f"error: {message}", file=sys.stderr)
    return status


def _show_warning(message: Warning | str, *_: object, **__: object) -> None:
    print(f"warning: {' '.join(str(message).split())}", file=sys.stderr)
