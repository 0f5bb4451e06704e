"""The probes of all families, counted by verdict."""

import pandas as pd

from fracstudy.inputs import Inputs, Result
from fracstudy.probe import Verdict


def study(inputs: Inputs, *, families: dict[str, dict[str, str]]) -> Result:
    """One row a family: what may go wrong, what tells you, how many probes, and what came of them."""
    rows = []
    for name, words in families.items():
        probes = inputs.tables[name]
        verdicts = probes["verdict"].value_counts()
        rows.append(
            {
                "family": name.replace("_", " "),
                **words,
                "probes": len(probes),
                **{str(verdict): int(verdicts.get(str(verdict), 0)) for verdict in Verdict},
                "against independent values": int((probes["source"].fillna("") != "").sum()),
            }
        )
    table = pd.DataFrame(rows)
    if rows:
        numbers = table.select_dtypes("number").sum()
        table.loc[len(table)] = {
            "family": "all",
            "what may go wrong": "",
            "what tells you": "",
            **numbers,
        }
    return Result(table)
