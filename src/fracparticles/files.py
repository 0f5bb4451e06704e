"""Files that are whole or not there: written under a temporary name, renamed when they are done."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from fracparticles.errors import InvalidInput

__all__ = ["replaceable", "replacing", "write_text"]


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
        raise InvalidInput(
            field,
            str(given),
            "a regular file, and this is a device, a pipe or a socket: only files are replaced",
            "Choose another one.",
        )
    if given.is_symlink() and not given.exists():
        raise InvalidInput(
            field,
            str(given),
            f"a file, and this is a link to {str(target)!r}, which does not exist",
            "Remove the link, or make what it links to.",
        )
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
