"""The command line: `fracparticles solve`, `show`, `plot`, `compare` and `limit`.

Results go to standard output, and everything else to standard error, one line each. The exit status is 0 for a run that
is done, 1 if the machine failed (a full disk, no memory), 2 if the input cannot be used, 3 if the solution blew up, and
130 if the run was interrupted. Nothing that takes long is imported before `main` runs, which reports an interruption.
"""

from __future__ import annotations

import os
import sys
import warnings
from collections.abc import Sequence
from io import TextIOWrapper

from fracparticles.errors import (
    FracparticlesError,
    FracparticlesWarning,
    InvalidInput,
    NonFiniteSolution,
)

__all__ = ["main"]


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line and return the exit status."""
    try:
        _open_streams()
        return _run(arguments)
    except KeyboardInterrupt:
        return _fail("interrupted", 130)


def _run(arguments: Sequence[str] | None) -> int:
    from cyclopts import CycloptsError, UnusedCliTokensError

    from fracparticles.command_line.program import app

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
        except UnusedCliTokensError as error:
            left = " ".join(error.unused_tokens or ())
            return _fail(f"{left!r} belongs to no option. Give --option value, lists as 1,2,3.", 2)
        except (CycloptsError, InvalidInput) as error:
            return _fail(error, 2)
        except NonFiniteSolution as error:
            return _fail(error, 3)
        except BrokenPipeError:
            # The reader, such as `head`, has ended. Nothing must be left for the interpreter to flush at exit.
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
            return 141  # 128 + SIGPIPE
        except (FracparticlesError, OSError, MemoryError) as error:
            return _fail(error, 1)
    return 0


def _open_streams() -> None:
    """Open streams that were closed on the null device. Otherwise the first file opened would receive their text.

    Characters that the terminal cannot show are shown as their codes.
    """
    for name, number, mode in (("stdin", 0, "r"), ("stdout", 1, "w"), ("stderr", 2, "w")):
        if getattr(sys, name) is None:
            descriptor = os.open(os.devnull, os.O_RDWR)
            if descriptor != number:
                os.dup2(descriptor, number)
                os.close(descriptor)
            setattr(sys, name, open(number, mode, encoding="utf-8"))  # noqa: SIM115
    if isinstance(sys.stdout, TextIOWrapper) and sys.stdout.errors == "strict":
        sys.stdout.reconfigure(errors="backslashreplace")


def _fail(error: object, status: int) -> int:
    message = " ".join(str(error).split()) or type(error).__name__
    print(f"error: {message}", file=sys.stderr)
    return status


def _show_warning(message: Warning | str, *_: object, **__: object) -> None:
    print(f"warning: {' '.join(str(message).split())}", file=sys.stderr)
