"""Join the printed claims and the findings of all scenes."""

import sys
from typing import Any

from fracstudy.claims import read_claims, read_findings
from fracstudy.ledger import ledger, write_ledger

snakemake: Any
sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)  # noqa: SIM115

rows = ledger(read_claims(*snakemake.input.printed), read_findings(snakemake.input.findings))
write_ledger(rows, snakemake.output.csv, snakemake.output.md)
