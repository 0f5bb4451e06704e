"""Numbers in prose: they are looked up in the results, never typed.

A caption or a page is a Jinja template. It may ask for

``{{ printed("L-T3.DD") }}``, ``{{ ours("L-T3.DD") }}``
    a printed value, and ours with two digits more;
``{{ cell("overlap", "error", ".1e", scheme="KPSE", order=4) }}``
    the one cell of a scene's table in the row that has these values;
``{{ least("overlap", "error", ".1e", scheme="KPSE") }}``, ``greatest`` likewise
    the least and the greatest of a column, over the rows that have these values;
``{{ count("rounding", verdict="held") }}``
    how many rows have these values;
``{{ summary }}``
    the ledger in one line.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import jinja2

from fracparticles.errors import FracparticlesError
from fracstudy.ledger_text import ours_text, read_ledger, summary_line

if TYPE_CHECKING:
    import pandas as pd

__all__ = ["LookUpError", "LookUps"]


class LookUpError(FracparticlesError, ValueError):
    """A text asks for something that does not exist; the message names both."""


class LookUps:
    """The numbers that texts may ask for.

    Parameters
    ----------
    results : Path
        The folder of the results: `claims.csv` and `tables/`.
    """

    def __init__(self, results: Path) -> None:
        self.ledger = read_ledger(results / "claims.csv")
        self._claims = self.ledger.set_index("id")
        self._results = results
        self._table = cache(self._read)

    def filled(self, path: Path, **more: Any) -> str:
        """Return the text of a file with the numbers that it asks for.

        Raises
        ------
        LookUpError
            If the template cannot be read, or asks for something that does not exist; names the file.
        """
        environment = jinja2.Environment(undefined=jinja2.StrictUndefined, autoescape=False)
        environment.globals |= {
            "printed": lambda claim: self._claim(claim)["printed"],
            "ours": lambda claim: ours_text(*self._claim(claim)[["printed", "ours"]]),
            "cell": self._cell,
            "least": partial(self._end, min),
            "greatest": partial(self._end, max),
            "count": lambda scene, **where: len(self._rows(scene, where)),
            "summary": summary_line(self.ledger),
            **more,
        }
        try:
            return environment.from_string(path.read_text("utf-8")).render().strip()
        except jinja2.TemplateSyntaxError as error:
            raise LookUpError(f"{path}, line {error.lineno}: {error}") from error
        except (jinja2.UndefinedError, LookUpError, TypeError, ValueError) as error:
            raise LookUpError(f"{path}: {error}") from error

    def _claim(self, claim: str) -> pd.Series:
        if claim not in self._claims.index:
            raise LookUpError(f"the ledger has no claim {claim}")
        return self._claims.loc[claim]

    def _cell(self, scene: str, column: str, form: str = "", **where: Any) -> str:
        found = self._column(scene, column, where)
        if len(found) != 1:
            raise LookUpError(f"the table of {scene} has {len(found)} rows with {where}, not one")
        return format(found.iloc[0], form)

    def _end(
        self,
        end: Callable[[pd.Series], float],
        scene: str,
        column: str,
        form: str = "",
        **where: Any,
    ) -> str:
        found = self._column(scene, column, where).dropna()
        if found.empty:
            raise LookUpError(f"the table of {scene} has no {column} with {where}")
        return format(end(found), form)

    def _column(self, scene: str, column: str, where: dict[str, Any]) -> pd.Series:
        rows = self._rows(scene, where)
        if column not in rows:
            raise LookUpError(f"the table of {scene} has no column {column}: {', '.join(rows)}")
        return rows[column]

    def _rows(self, scene: str, where: dict[str, Any]) -> pd.DataFrame:
        rows = self._table(scene)
        for name, value in where.items():
            if name not in rows:
                raise LookUpError(f"the table of {scene} has no column {name}: {', '.join(rows)}")
            rows = rows[rows[name] == value]
        return rows

    def _read(self, scene: str) -> pd.DataFrame:
        import pandas as pd

        path = self._results / f"tables/{scene}.csv"
        if not path.is_file():
            raise LookUpError(f"there is no scene {scene}")
        return pd.read_csv(path)
