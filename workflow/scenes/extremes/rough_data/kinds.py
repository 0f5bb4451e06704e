"""Data of every kind of array: what they hold is worked with, or refused in one line."""

from collections.abc import Callable, Iterator
from fractions import Fraction
from typing import Any

import numpy as np
import pandas as pd

from fracparticles.run.solver import prepare
from fracstudy.probe import HELD, REFUSED, Kind, Probe
from scenes.extremes.rough_data.cases import case_of, deviation, run


def probes(beta: float) -> Iterator[Probe]:
    """Numbers of other types are those numbers; nan, inf, masks, complex ones, words, wrong shapes are refused."""
    case = case_of("KPSE", beta)
    bump = np.round(100.0 * np.exp(-case.x * case.x))
    exact = run(case, bump)
    same = Kind("kind of data", "as float64", must=HELD)
    refused = Kind("refused", bound=-1.0, must=REFUSED)
    for words, data in _right(bump).items():
        yield same(words, lambda: deviation(run(case, data), exact))
    for words, make in _wrong(bump).items():
        yield refused(f"{words}, solve", lambda: run(case, make()))
        if not words.startswith("function"):
            yield refused(f"{words}, prepare", lambda: prepare(case).solve(make()))


def _right(bump: np.ndarray) -> dict[str, Any]:
    wide = np.repeat(bump, 2)
    return {
        "int8": bump.astype(np.int8),
        "uint64": bump.astype(np.uint64),
        "float16, exact numbers": bump.astype(np.float16),
        "float32, exact numbers": bump.astype(np.float32),
        "longdouble": bump.astype(np.longdouble),
        "big-endian": bump.astype(">f8"),
        "a list": bump.tolist(),
        "a tuple of integers": tuple(bump.astype(int).tolist()),
        "every other entry": wide[::2],
        "backwards": bump[::-1].copy()[::-1],
        "read only": np.frombuffer(bump.tobytes()),
        "a mask that masks nothing": np.ma.array(bump, mask=False),
        "a Series that counts": pd.Series(bump),
        "a function": lambda x: np.round(100.0 * np.exp(-x * x)),
    }


def _wrong(bump: np.ndarray) -> dict[str, Callable[[], Any]]:
    def with_one(value: Any, kind: type = float) -> Callable[[], Any]:
        def make() -> Any:
            data: np.ndarray = bump.astype(kind)
            data[3] = value
            return data

        return make

    return {
        "nan": with_one(np.nan),
        "inf": with_one(np.inf),
        "-inf": with_one(-np.inf),
        "inf and -inf": lambda: np.where(np.arange(bump.size) % 2, np.inf, -np.inf),
        "a mask": lambda: np.ma.array(bump, mask=np.arange(bump.size) == 3),
        "complex": with_one(1j, complex),
        "complex of no imaginary part": lambda: bump.astype(complex),
        "bool": lambda: bump > 0.0,
        "objects": lambda: bump.astype(object),
        "fractions": lambda: [Fraction(int(value), 3) for value in bump],
        "words": lambda: bump.astype(str),
        "dates": lambda: bump.astype("datetime64[s]"),
        "records": lambda: np.zeros(bump.size, dtype=[("u", float)]),
        "one too many": lambda: np.append(bump, 0.0),
        "a column": lambda: bump[:, None],
        "empty": lambda: np.zeros(0),
        "ragged": lambda: [[1.0], [1.0, 2.0]],
        "a number": lambda: 1.0,
        "an integer of 400 digits": lambda: [10**400] + [0] * (bump.size - 1),
        "longdouble beyond float64": lambda: np.full(bump.size, np.longdouble("1e400")),
        "function that gives nan": lambda: lambda x: np.where(x == 0.0, np.nan, x),
        "function that gives one value less": lambda: lambda x: x[1:],
        "function that gives complex numbers": lambda: lambda x: x + 0j,
    }
