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
from typing import Annotated, Any

from cyclopts import App, CycloptsError, Parameter

from fracparticles import __version__
from fracparticles.errors import (
    FracparticlesError,
    FracparticlesWarning,
    InvalidInput,
    NonFiniteSolution,
)

__all__ = ["app", "main", "number_or_text"]

app = App(
    name="fracparticles",
    help="Particle methods for space-fractional diffusion.",
    version=__version__,
    suppress_keyboard_interrupt=False,  # `main` reports it
)
# By its address: the flags are the fields of Case, which takes the whole core to import.
app.command(
    "fracparticles.run.cli_solve:solve", name="solve", help="Run a case and write its file."
)


# Flags are read as text, and this makes numbers of them, so that text where a number belongs is refused in the same
# words as in Python.
Number = Annotated[str, Parameter(metavar="NUMBER")]


def number_or_text(text: str) -> Any:
    """Return the number that the text stands for, or the text if it stands for none."""
    for number in (int, float):
        try:
            return number(text)
        except ValueError:
            continue
    return text


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


@app.command
def limit(
    *,
    scheme: str,
    beta: Number,
    order: Number = "2",
    overlap: Number | None = None,
    dim: Number = "1",
    kernel_family: str | None = None,
    spacing: Number | None = None,
    diffusivity: Number = "1.0",
) -> None:
    """Print the stability limit a of Eq. (55), and with --spacing the largest stable time step.

    Explicit Euler and the midpoint rule are stable for D dt / h^alpha <= a, Eq. (56). A single step of GPSE, over the
    whole time, has no limit.

    Parameters
    ----------
    scheme : str
        Name of a scheme.
    beta : float
        Fractional order, 0 < beta < 1.
    order : {2, 4, 6, 8, 10, 12}
        Order of the kernels.
    overlap : float
        epsilon / h; 2 if left out.
    dim : {1, 2, 3}
        Space dimension.
    kernel_family : {printed, gamma}
        Family of the kernels; printed for orders 2 and 4, gamma beyond if left out.
    spacing : float
        Particle spacing h.
    diffusivity : float
        D of Eq. (2).
    """
    from fracparticles.arguments import positive_real
    from fracparticles.schemes import scheme as find_scheme
    from fracparticles.schemes.stability import stability_limit

    if overlap is not None and not find_scheme(scheme).has_kernel:
        allowed = f"nothing for {scheme}, which has no kernel"
        raise InvalidInput("overlap", overlap, allowed, "Leave it out.")
    numbers = [number_or_text(text) for text in (beta, order, overlap or "2.0", dim)]
    a = stability_limit(scheme, *[*numbers, kernel_family])
    lines = [f"a = {a:.6g}"]
    rate = positive_real("diffusivity", number_or_text(diffusivity))
    if spacing is not None:
        h = positive_real("spacing", number_or_text(spacing))
        lines.append(f"dt = {a * h ** (1.0 + float(beta)) / rate:.6g}")
    print("\n".join(lines))
    if find_scheme(scheme).self_timed:
        _note(
            f"this binds steps that are repeated; a single step of {scheme}, over the whole time, has no limit"
        )
    if a == 0.0:
        _note("no step is stable, some wave grows: take a larger overlap or a lower order")


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


def _note(text: str) -> None:
    print(f"note: {text}", file=sys.stderr)


def _show_warning(message: Warning | str, *_: object, **__: object) -> None:
    print(f"warning: {' '.join(str(message).split())}", file=sys.stderr)
