"""What holds of the command line: done with a whole file, or a line on standard error and nothing else."""

# ruff: noqa: B008  an argument of a property is drawn from its default

import io
import os
import tempfile
from collections.abc import Mapping
from contextlib import chdir, redirect_stderr, redirect_stdout
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from hypothesis import strategies as st

import fracparticles as fp
from fracparticles.command_line.cli import main
from fracparticles.errors import InvalidInput
from scenes.extremes.fuzzing.cases import as_given, cases, refuse_dear
from scenes.extremes.fuzzing.harness import always
from scenes.extremes.fuzzing.strategies import chance, fields_of, texts

_STATUSES = (0, 1, 2, 3)  # done, the machine, the input, the solution
_SPEAKS = ("error: ", "warning: ", "note: ")
_FLAGS = [f"--{name.replace('_', '-')}" for name in fp.Case.model_fields]
_OTHERS = ["-o", "--output", "--time-step", "--spacing", "--help", "--version", "--", "-", "--no-x"]
_VALUES = [
    "solve",
    "show",
    "limit",
    "run.nc",
    "1e-400",
    "0x10",
    "1,5",
    "nan",
    "1e",
    "٣",
    "-1",
    "--beta=",
]
_WORDS = st.one_of(texts(), st.sampled_from([*_FLAGS, *_OTHERS]), st.sampled_from(_VALUES))
_FILES = ("run.nc", "run.nc", "run.nc", "a/run.nc", ".", "/dev/null", "")


def _text(value: Any) -> str:
    return repr(value) if isinstance(value, float) else str(value)


@st.composite
def _solving(draw: st.DrawFn) -> list[str]:
    """Draw the flags of a case that is allowed, some of them spoilt."""
    case = draw(cases())
    words = ["solve", "-o", draw(st.sampled_from(_FILES))]
    for name, value in as_given(case).items():
        if value is not None and not draw(chance(2)):
            spoilt = draw(chance(4))
            one = draw(st.one_of(fields_of(fp.Case)[name], texts())) if spoilt else value
            words.append(f"--{name.replace('_', '-')}={_text(one)}")
    if draw(chance(15)):
        words.insert(draw(st.integers(0, len(words))), draw(_WORDS))
    return words


def _flags(given: Mapping[str, Any]) -> list[str]:
    """The fields that are given as flags."""
    return [f"--{n.replace('_', '-')}={_text(v)}" for n, v in given.items() if v is not None]


_CASE = fields_of(fp.Case)
_LIMITS = st.fixed_dictionaries(
    {name: _CASE[name] for name in ("scheme", "beta")},
    optional={
        name: _CASE[name] for name in ("order", "overlap", "kernel_family", "spacing", "dim")
    },
).map(lambda given: ["limit", *_flags(given)])


@always("the command line", "done, or a line", share=8)
def _spoken(words=st.one_of(_solving(), _LIMITS, st.lists(_WORDS, max_size=6))):
    """Any words end with a status, and with lines that say what they are."""
    _refuse_dear_words(words)
    with tempfile.TemporaryDirectory() as folder, chdir(folder):
        status, out, err = _run(words)
        files = [file for file in Path(folder).rglob("*") if not file.is_dir()]
        wrong = status not in _STATUSES
        wrong |= not all(line.startswith(_SPEAKS) for line in err.splitlines())
        wrong |= (status != 0) != ("error: " in err)
        wrong |= status != 0 and (out != "" or files != [])
        if status == 0 and files:
            wrong |= len(files) != 1 or not _is_whole(files[0])
        return 2.0 * wrong


@always("flags of a case", "the bits of Python")
def _same(case=cases()):
    """The flags of a case write the bits that Python writes, or refuse what it refuses."""
    refuse_dear(case)
    words = ["solve", "--output=run.nc", *_flags(as_given(case))]
    with tempfile.TemporaryDirectory() as folder, chdir(folder):
        status, _, err = _run(words)
        try:
            fp.write(fp.solve(case), "other.nc")
        except (InvalidInput, fp.NonFiniteSolution) as error:
            expected = 2 if isinstance(error, InvalidInput) else 3
            return 2.0 * (status != expected or str(error) not in err)
        return 2.0 * (status != 0 or Path("run.nc").read_bytes() != Path("other.nc").read_bytes())


@cache
def _whole_file() -> bytes:
    case = fp.Case(scheme="FD", beta=0.5, half_width=4.0, spacing=0.5, integrator="exponential")
    with tempfile.TemporaryDirectory() as folder:
        fp.write(fp.solve(case), Path(folder) / "run.nc")
        return (Path(folder) / "run.nc").read_bytes()


@st.composite
def _spoilt_files(draw: st.DrawFn) -> bytes:
    """Draw the bytes of a run's file, cut short or with some of them changed."""
    content = bytearray(_whole_file())
    if draw(st.booleans()):
        return bytes(content[: draw(st.integers(0, len(content)))])
    for _ in range(draw(st.integers(0, 20))):
        content[draw(st.integers(0, len(content) - 1))] = draw(st.integers(0, 255))
    return bytes(content)


@always("show, a spoilt file", "shown, or a line", share=3)
def _shown(content=_spoilt_files()):
    """What is in a file is shown, or refused in a line."""
    with tempfile.TemporaryDirectory() as folder, chdir(folder):
        Path("run.nc").write_bytes(content)
        status, out, err = _run(["show", "run.nc"])
        wrong = (status, out) != (2, "") or err.count("\n") != 1 if status else err != ""
        return 2.0 * (wrong or os.listdir(folder) != ["run.nc"])


def _run(words: list[str]) -> tuple[int, str, str]:
    with redirect_stdout(io.StringIO()) as out, redirect_stderr(io.StringIO()) as err:
        status = main(words)
    return status, out.getvalue(), err.getvalue()


def _is_whole(file: Path) -> bool:
    return bool(np.isfinite(float(fp.read_run(file)["mass_final"])))


def _refuse_dear_words(words: list[str]) -> None:
    """Read the flags as the command line does, and leave out what would take too long here."""
    from fracparticles.command_line.commands import number_or_text

    names = dict(zip(_FLAGS, fp.Case.model_fields, strict=True))
    given = dict(word.split("=", 1) for word in words if "=" in word)
    fields = {names[flag]: value for flag, value in given.items() if flag in names}
    try:
        case = fp.Case(**{name: number_or_text(value) for name, value in fields.items()})
    except InvalidInput:
        return
    refuse_dear(case)
