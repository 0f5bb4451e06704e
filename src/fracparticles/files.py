"""Files that are whole or not there, written under a temporary name and renamed when done; and how NetCDF is read."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fracparticles.errors import InvalidInput, reason_of

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["load_netcdf", "replaceable", "replacing", "write_text"]


def replaceable(path: Any, field: str = "path") -> Path:
    """Return the file that `path` stands for, a regular one or none yet: links are followed.

    Raises
    ------
    InvalidInput
        If there is a directory, a device, a pipe or a socket, or a link to nothing.
    """
    if not isinstance(path, str | os.PathLike) or "\0" in os.fsdecode(path):
        raise InvalidInput(field, path, "the path of a file", "Give such a path.")
    given = Path(os.fsdecode(path))
    target = Path(os.path.realpath(given))
    if given.is_dir():
        raise InvalidInput(field, str(given), "a file, and this is a directory", "Add a file name.")
    if given.exists() and not given.is_file():
        regular = (
            "a regular file, and this is a device, a pipe or a socket: only files are replaced"
        )
        raise InvalidInput(field, str(given), regular, "Choose another one.")
    if given.is_symlink() and not given.exists():
        linked = f"a file, and this is a link to {str(target)!r}, which does not exist"
        remedy = "Remove the link, or make what it links to."
        raise InvalidInput(field, str(given), linked, remedy)
    return target


@contextmanager
def replacing(path: Any) -> Iterator[Path]:
    """Give a temporary path beside the file `path`, which takes its place when the block ends without an error.

    The file gets the mode that the umask gives; folders are made. A link is followed: what it links to is replaced.

    Raises
    ------
    InvalidInput
        If `path` is there and not a regular file.
    OSError
        If the folder cannot be made or written.
    """
    target = replaceable(path)
    target.parent.mkdir(parents=True, exist_ok=True)
    stem = target.stem.encode(errors="ignore")[:80].decode(errors="ignore")
    temporary = target.with_name(f".{stem}-{os.urandom(8).hex()}{target.suffix[:40]}")
    # Made here and now: it is ours alone, and its mode is what the umask leaves.
    os.close(os.open(temporary, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666))
    try:
        yield temporary
        os.replace(temporary, target)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise


def write_text(path: Any, text: str) -> None:
    """Write a text file, as UTF-8 with lines that end in a line feed.

    Raises
    ------
    InvalidInput, OSError
        As `replacing`.
    """
    with replacing(path) as temporary:
        temporary.write_text(text, encoding="utf-8", newline="\n")


def load_netcdf(path: Path, names: Sequence[str] | None = None) -> xr.Dataset:
    """Read a NetCDF file, or some variables of it: no other is decoded. Units of time are left as they are.

    Raises
    ------
    InvalidInput
        If there is no readable NetCDF file.
    """
    import xarray as xr

    if path.exists() and not path.is_file() and not path.is_dir():
        raise InvalidInput("file", str(path), "a regular file", "Copy the data into one.")
    try:
        with xr.open_dataset(path, engine="netcdf4", decode_cf=False) as raw:
            wanted = raw
            if names is not None:
                wanted = raw[[name for name in names if name in raw.variables]]
                wanted = wanted.drop_vars([name for name in wanted.coords if name not in names])
            return xr.decode_cf(wanted, decode_times=False).load()
    except FileNotFoundError:
        raise InvalidInput("file", str(path), "an existing file", "Check the path.") from None
    except Exception as error:  # the library raises many kinds for damaged files
        readable = f"a readable NetCDF file ({reason_of(error)})"
        raise InvalidInput("file", str(path), readable, "Write or copy it again.") from None
