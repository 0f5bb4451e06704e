"""Files that are whole or not there: written under a temporary name and renamed when done. NetCDF is read here, too.

NetCDF does not notice a changed byte: the number to which it belongs is then another one. So our files are sealed. They
end with the digest of all bytes before it, where the NetCDF libraries do not look.
"""

from __future__ import annotations

import os
import re
import signal
import threading
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from hashlib import file_digest, sha256
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fracparticles.errors import InvalidInput, reason_of

if TYPE_CHECKING:
    import xarray as xr

__all__ = [
    "intact",
    "load_netcdf",
    "replaceable",
    "replacing",
    "seal",
    "uninterrupted",
    "write_text",
]

_SEAL = b"\nsha256 "
_LENGTH = len(_SEAL) + 64 + 1  # bytes of a seal, with the digest and the end of the line


def replaceable(path: Any, field: str = "path") -> Path:
    """Return the file to which `path` leads, a regular one or none yet; links are followed.

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

    The file gets the mode that the umask gives; folders are made. A link is followed: the file to which it leads is
    replaced. Temporary files of the same file that a killed call has left are removed.

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
    before, after = f".{stem}-", target.suffix[:40]
    with _in_use(target.parent, re.compile(f"{re.escape(before)}[0-9a-f]{{16}}{re.escape(after)}")):
        temporary = target.with_name(f"{before}{os.urandom(8).hex()}{after}")
        # Made here and now: it is ours alone, and its mode is what the umask leaves.
        os.close(os.open(temporary, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666))
        try:
            yield temporary
            os.replace(temporary, target)
        except BaseException:
            with suppress(OSError):  # the folder may be gone
                temporary.unlink(missing_ok=True)
            raise


@contextmanager
def _in_use(folder: Path, left: re.Pattern[str]) -> Iterator[None]:
    """Mark a folder as written to; if nobody else writes to it, first remove the temporary files left there.

    The mark is a lock of the folder, shared by all who write. The system releases it when a process ends, whatever ends
    it. Where there are no such locks, nothing is removed.
    """
    handle = None
    try:
        with suppress(ImportError, OSError):
            from fcntl import LOCK_EX, LOCK_NB, LOCK_SH, flock

            handle = os.open(folder, os.O_RDONLY)
            try:
                flock(handle, LOCK_EX | LOCK_NB)
                for name in filter(left.fullmatch, os.listdir(folder)):
                    (folder / name).unlink()
            finally:
                flock(handle, LOCK_SH | LOCK_NB)
        yield
    finally:
        if handle is not None:
            os.close(handle)


@contextmanager
def uninterrupted() -> Iterator[None]:
    """Put off an interrupt, Ctrl-C, to the end of a block that holds locks, which it could leave closed for ever."""
    before = signal.getsignal(signal.SIGINT)
    if before is None or threading.current_thread() is not threading.main_thread():
        yield  # only the main thread is interrupted, and only by what Python knows of
        return
    came: list[int] = []
    signal.signal(signal.SIGINT, lambda number, _: came.append(number))
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
        if came:
            signal.raise_signal(signal.SIGINT)


def write_text(path: Any, text: str) -> None:
    """Write a text file, as UTF-8 with lines that end in a line feed.

    Raises
    ------
    InvalidInput, OSError
        As `replacing`.
    """
    with replacing(path) as temporary:
        temporary.write_text(text, encoding="utf-8", newline="\n")


def seal(path: Path) -> None:
    """End a file with the digest of its content, a line "sha256 ..."."""
    with open(path, "rb+") as file:
        file.write(_seal_of(file_digest(file, "sha256")))  # which reads to the end


def _seal_of(digest: Any) -> bytes:
    return _SEAL + digest.hexdigest().encode() + b"\n"


def intact(path: Path) -> Path:
    """Return the path of a NetCDF file that is as it was sealed, or has no seal: another program has written it.

    Raises
    ------
    InvalidInput
        If its digest is another one, the seal is cut short, or more bytes follow it.
    OSError
        If it cannot be read.
    """
    with open(path, "rb") as file:
        content = file.read()
    at = content.rfind(_SEAL, max(0, len(content) - 2 * _LENGTH))
    if at >= 0 and content[at:] != _seal_of(sha256(memoryview(content)[:at])):
        readable = "a readable NetCDF file (it has changed since it was written, says its digest)"
        raise InvalidInput("file", str(path), readable, "Write or copy it again.")
    return path


def load_netcdf(path: Path, names: Sequence[str] | None = None) -> xr.Dataset:
    """Read a NetCDF file, or only the variables of these names. Units of time are left as they are.

    Raises
    ------
    InvalidInput
        If there is no readable NetCDF file, or one of ours that has changed since it was written.
    """
    import xarray as xr

    try:
        if path.exists() and not path.is_file() and not path.is_dir():
            raise InvalidInput("file", str(path), "a regular file", "Copy the data into one.")
        whole = intact(path)
        with uninterrupted(), xr.open_dataset(whole, engine="netcdf4", decode_cf=False) as raw:
            wanted = raw
            if names is not None:
                wanted = raw[[name for name in names if name in raw.variables]]
                wanted = wanted.drop_vars([name for name in wanted.coords if name not in names])
            return xr.decode_cf(wanted, decode_times=False).load()
    except InvalidInput:
        raise
    except FileNotFoundError:
        raise InvalidInput("file", str(path), "an existing file", "Check the path.") from None
    except Exception as error:  # the library raises many kinds for damaged files
        readable = f"a readable NetCDF file ({reason_of(error)})"
        raise InvalidInput("file", str(path), readable, "Write or copy it again.") from None
