"""Join the printed claims and the findings of all scenes."""

import sys
from typing import Any

from fracstudy.findings import read_findings
from fracstudy.ledger import ledger
from fracstudy.ledger_text import write_ledger
from fracstudy.printed import read_printed

snakemake: Any
sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)  # noqa: SIM115

rows = ledger(
    read_printed(*snakemake.input.printed),
    read_findings(snakemake.input.findings),
    smoke=snakemake.params.smoke,
)
write_ledger(rows, snakemake.output.csv, snakemake.output.md)
