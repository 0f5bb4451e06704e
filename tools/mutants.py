"""Change the code in small ways, one at a time, and see whether a test fails: `make mutants`.

A mutant is a copy of the project with one change: another operator or comparison, a truth value turned round, a whole
number by one or a decimal by a tenth off, a loop that never runs. Each module of the numerical core and of the ledger
has as many as its share of all lines, one on a line. A mutant of results/mutants.csv stays in the sample as long as its
line stays in the code; the rest is drawn. One that no test kills is a gap in the tests, or harmless:
tools/harmless_mutants.yaml says which are and why. The run fails for a survivor that is not listed there, and where the
list names a mutant that does not exist or that a test kills.

Each mutant meets the tests that can see it, the nearest first: those that run its line, ahead of those that run
another line of its module, ahead of those of its room (compiled code leaves no trace in the coverage). Of two, the
nearer spends more of its lines in that module. They are taken until they add up to a number of seconds.

All of it takes place in copies. The first one runs all tests undisturbed, for the coverage and the times.
"""

from __future__ import annotations

import argparse
import ast
import json
import multiprocessing
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile
import time
from collections import Counter, defaultdict
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from xml.etree import ElementTree

import pandas as pd
import parso
import yaml
from cosmic_ray.ast import ast_nodes, get_ast
from cosmic_ray.mutating import mutate_code
from cosmic_ray.operators.number_replacer import NumberReplacer
from cosmic_ray.operators.operator import Operator
from cosmic_ray.plugins import get_operator, operator_names
from coverage import CoverageData

ROOT = Path(__file__).resolve().parent.parent
SOURCES = ROOT / "src"
HARMLESS = ROOT / "tools/harmless_mutants.yaml"
TABLE = ROOT / "results/mutants.csv"
CORE = (
    "special", "kernels", "lattice", "schemes", "time", "moving", "graded", "markers", "sph", "pse",
)  # fmt: skip
ROOMS = {
    **{room: rf"fracparticles/{room}/\w+\.py" for room in CORE},
    "run": r"fracparticles/run/(reliability|strengths)\.py",
    "the ledger": r"fracstudy/(criteria|claims|findings|ledger|orders|probe)\.py",
}
# These start processes of their own, or the whole workflow.
TOO_LARGE = ("tests/test_workflow.py", "tests/test_installation.py", "tests/test_packaging.py")
NOT_COPIED = (".git", ".venv*", ".*_cache", ".snakemake", "results-smoke")
CAME = ["killed", "killed by the time limit", "survived"]
SOON = 1.5  # seconds of tests that come before the others are even collected
for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS"):
    os.environ[variable] = "1"
os.environ.pop("NUMBA_CACHE_DIR", None)  # kept beside the modules: a copy has what is compiled
# A mutant's tests begin in a process that has loaded the libraries already.
FORKED = multiprocessing.get_context("forkserver")
LIBRARIES = ["hypothesis", "netCDF4", "numba", "pandas", "pyfftw", "pytest", "scipy", "xarray"]
FORKED.set_forkserver_preload(["__main__", *LIBRARIES])

_ARITHMETIC = "(Add|Sub|Mul|Div|FloorDiv|Mod|Pow)"
_ORDER = "(Eq|NotEq|Lt|LtE|Gt|GtE)"
KINDS = re.compile(
    rf"core/(ReplaceBinaryOperator_({_ARITHMETIC}_{_ARITHMETIC}|BitOr_BitAnd|BitAnd_BitOr)"
    rf"|ReplaceComparisonOperator_({_ORDER}_{_ORDER}|Is_IsNot|IsNot_Is)"
    r"|ReplaceUnaryOperator_Delete_(USub|Not)|AddNot|ZeroIterationForLoop"
    r"|Replace(True|False|And|Or|Break|Continue)With\w+)"
)


class OtherNumber(NumberReplacer):
    """A decimal by a tenth, another number by one."""

    def mutate(self, node: parso.python.tree.Number, index: int) -> parso.python.tree.Number:
        """Return the other number."""
        number = ast.literal_eval(node.value)
        if re.fullmatch(r"\d*\.\d*", node.value) and number:
            other = f"{number * (0.9, 1.1)[index]:.12g}"
        else:
            other = str(number + (1, -1)[index])
        return parso.python.tree.Number(other, node.start_pos, node.prefix)


OPERATORS: list[Operator] = [
    *(get_operator(name)() for name in sorted(operator_names()) if KINDS.fullmatch(name)),
    OtherNumber(),
]


@dataclass(frozen=True)
class Mutant:
    """A file with a change in one line.

    Attributes
    ----------
    file : str
        Relative to src.
    line : int
        The number of the line, from 1.
    operator : Operator
        What makes the change.
    occurrence : int
        At which of its places in the file.
    """

    file: str
    line: int
    operator: Operator
    occurrence: int

    @cached_property
    def source(self) -> str:
        """The file after the change."""
        text = (SOURCES / self.file).read_text("utf-8")
        return str(mutate_code(text, self.operator, self.occurrence))

    @cached_property
    def name(self) -> tuple[str, str, str]:
        """The file, the line as it was, and as it is."""
        was = (SOURCES / self.file).read_text("utf-8").splitlines()[self.line - 1]
        return self.file, was.strip(), self.source.splitlines()[self.line - 1].strip()

    @property
    def compiles(self) -> bool:
        """Whether it is a program: the star of keyword arguments looks like a product."""
        with suppress(SyntaxError):
            ast.parse(self.source)
            return True
        return False


def mutants_of(file: str) -> dict[int, list[Mutant]]:
    """Return all mutants of a file, by line; what stands in annotations is left alone."""
    text = (SOURCES / file).read_text("utf-8")
    annotations = [
        ((node.lineno, node.col_offset), (node.end_lineno, node.end_col_offset))
        for parent in ast.walk(ast.parse(text))
        for node in (getattr(parent, "annotation", None), getattr(parent, "returns", None))
        if node
    ]
    nodes = [*ast_nodes(get_ast(text))]
    found = defaultdict(list)
    for operator in OPERATORS:
        places = (place for node in nodes for place in operator.mutation_positions(node))
        for occurrence, (begin, _) in enumerate(places):
            if not any(first <= begin < end for first, end in annotations):
                found[begin[0]].append(Mutant(file, begin[0], operator, occurrence))
    return found


def named(file: str, names: set[tuple[str, str, str]]) -> list[Mutant]:
    """Return the mutants of a file that have these names, the first of each."""
    lines = (SOURCES / file).read_text("utf-8").splitlines()
    wanted = {was for where, was, _ in names if where == file}
    found: dict[tuple[str, str, str], Mutant] = {}
    for line, mutants in sorted(mutants_of(file).items()):
        if lines[line - 1].strip() in wanted:
            found |= {m.name: m for m in reversed(mutants) if m.name in names - found.keys()}
    return list(found.values())


def sample(number: int, seed: int) -> list[Mutant]:
    """Return from each module as many mutants as its share: those of the last sample, and others from other lines."""
    files = [path.relative_to(SOURCES).as_posix() for path in sorted(SOURCES.rglob("*.py"))]
    lines = {file: mutants_of(file) for file in files if room_of(file)}
    total = sum(map(len, lines.values()))
    last = set(pd.read_csv(TABLE)[["file", "was", "becomes"]].itertuples(index=False, name=None))
    drawn = []
    for file, mutants in lines.items():
        dice = random.Random(f"{seed} {file}")  # one module does not depend on another
        share = max(1, round(number * len(mutants) / total)) if mutants else 0
        kept = named(file, last)[:share]
        others = sorted(mutants.keys() - {mutant.line for mutant in kept})
        for line in dice.sample(others, share - len(kept)):
            candidates = [m for m in dice.sample(mutants[line], len(mutants[line])) if m.compiles]
            kept += candidates[:1]
        drawn += sorted(kept, key=lambda mutant: mutant.line)
    return drawn


def room_of(file: str) -> str | None:
    """Return the room that a file belongs to; None for the files that are not changed."""
    return next((room for room, pattern in ROOMS.items() if re.fullmatch(pattern, file)), None)


class Tests:
    """What an undisturbed run of all tests in a copy of the project tells: what they see and how long they take."""

    def __init__(self, folder: Path, jobs: int) -> None:
        self.tree = folder / "tree"
        times, coverage, settings = (folder / name for name in ("tests.xml", "coverage", "ini"))
        if not times.exists():
            shutil.copytree(ROOT, self.tree, ignore=shutil.ignore_patterns(*NOT_COPIED))
            settings.write_text(
                f"[run]\nrelative_files = 1\ndata_file = {coverage}\nsource = src\n"
            )
            subprocess.run(
                [sys.executable, "-mpytest", "-q", "-pno:cacheprovider", f"-n{jobs}"]
                + ["--dist=loadscope", f"--junitxml={times}", "-ojunit_family=xunit1"]
                + ["--cov", f"--cov-config={settings}", "--cov-context=test", "--cov-report="]
                + [f"--ignore={path}" for path in TOO_LARGE],
                cwd=self.tree,
                env={**os.environ, "PYTHONPATH": str(self.tree / "src")},
            )
        self.seconds = {
            f"{case.get('file')}::{case.get('name')}": float(case.get("time", 0.0))
            for case in ElementTree.parse(times).iter("testcase")
            if not {"failure", "error", "skipped"} & {child.tag for child in case}
        }
        data = CoverageData(str(coverage))
        data.read()
        self.by_line = {
            file.removeprefix("src/"): {
                line: {name for context in contexts if (name := context.rpartition("|")[0])}
                for line, contexts in data.contexts_by_lineno(file).items()
            }
            for file in data.measured_files()
        }
        self.lines = {
            file: Counter(test for tests in by_line.values() for test in tests)
            for file, by_line in self.by_line.items()
        }
        for counts in self.lines.values():  # a test that runs no line of ours is where its file is
            for test, count in list(counts.items()):
                counts[test.partition("::")[0]] += count
        self.all_lines = sum(self.lines.values(), Counter())

    def nearest(self, mutant: Mutant, seconds: float) -> tuple[list[str], list[str]]:
        """Return the tests that can see a mutant, the nearest of them and those that come then."""
        at_line = self.by_line.get(mutant.file, {}).get(mutant.line, set())
        in_file = self.lines.get(mutant.file, Counter())
        room = mutant.file.rpartition("/")[0]
        in_room = sum((n for file, n in self.lines.items() if file.startswith(room)), Counter())

        def farness(test: str) -> tuple[bool, float, float, str]:
            who = test if test in self.all_lines else test.partition("::")[0]
            total = self.all_lines[who] or 1
            return test not in at_line, -in_file[who] / total, -in_room[who] / total, test

        # One of each function comes before the same with other parameters.
        seen: Counter[tuple[bool, str]] = Counter()
        order: list[tuple[bool, bool, int, str]] = []
        for place, key in enumerate(sorted(map(farness, self.seconds))):
            if key[2] < 0.0:
                function = key[0], key[3].partition("[")[0]
                order.append((key[0], seen[function] > 0, place, key[3]))
                seen[function] += 1
        near: list[str] = []
        far: list[str] = []
        spent = 0.0
        for *_, test in sorted(order):
            if spent + self.seconds[test] <= seconds:
                spent += self.seconds[test]
                (near if spent < SOON else far).append(test)
        return near, far

    def outcome(self, mutant: Mutant, seconds: float) -> str:
        """Return what comes of a mutant, one of `CAME`."""
        with tempfile.TemporaryDirectory(dir=self.tree.parent) as folder:
            tree = Path(folder) / "tree"
            shutil.copytree(self.tree, tree, copy_function=os.link)
            (tree / "src" / mutant.file).unlink()
            (tree / "src" / mutant.file).write_text(mutant.source, "utf-8")
            for some in filter(None, self.nearest(mutant, seconds)):
                process = FORKED.Process(target=run_tests, args=(tree, some))
                process.start()
                process.join(60.0 + 5.0 * sum(map(self.seconds.__getitem__, some)))
                if process.is_alive():
                    process.kill()
                    process.join()
                    return "killed by the time limit"
                if process.exitcode:
                    return "killed"
        return "survived"


def run_tests(tree: Path, tests: list[str]) -> None:
    """Run tests in a copy of the project, up to the first that fails, and exit with pytest's status."""
    import pytest

    os.chdir(tree)
    os.environ["PYTHONPATH"] = str(tree / "src")
    sys.path.insert(0, str(tree / "src"))
    sys.dont_write_bytecode = True
    log = os.open("pytest.log", os.O_CREAT | os.O_WRONLY)
    os.dup2(log, 1)
    os.dup2(log, 2)
    arguments = ["-qx", *(f"-pno:{one}" for one in ("cacheprovider", "xdist", "pytest_cov"))]
    status = int(pytest.main([*arguments, *tests]))
    said = Path("pytest.log").read_text("utf-8", errors="replace")
    if status == pytest.ExitCode.USAGE_ERROR and "not found:" in said:
        # The mutant gives a test other parameters: the same tests, with whatever these are now.
        functions = dict.fromkeys(test.partition("[")[0] for test in tests)
        os.execv(sys.executable, [sys.executable, "-mpytest", *arguments, *functions])
    os._exit(status)


def read_harmless() -> dict[tuple[str, str, str], str]:
    """Return why mutants are harmless, by their names; all of them exist."""
    rows = yaml.safe_load(HARMLESS.read_text("utf-8"))
    listed = {(row["in"], row["was"], row["becomes"]): row["why"] for row in rows}
    exist = {m.name for file in {file for file, *_ in listed} for m in named(file, set(listed))}
    if unknown := listed.keys() - exist:
        sys.exit(f"{HARMLESS.name} names mutants that do not exist: {sorted(unknown)}")
    return listed


def report(table: pd.DataFrame) -> str:
    """Return what came of the mutants, in Markdown: by room, then each survivor."""
    counts = pd.crosstab(table["room"], table["came"]).reindex(columns=CAME, fill_value=0)
    counts = counts.reindex([room for room in ROOMS if room in counts.index])
    counts.loc["all"] = counts.sum()
    counts.insert(0, "mutants", counts.sum(axis=1))
    counts["harmless"] = table[table["why"] != ""].groupby("room").size()
    counts.loc["all", "harmless"] = (table["why"] != "").sum()
    counts["harmless"] = counts["harmless"].fillna(0).astype(int)
    survivors = table[table["came"] == "survived"]
    shown = pd.DataFrame({
        "in": survivors["file"],
        "line": "`" + survivors["was"] + "`",
        "changed": "`" + survivors["becomes"] + "`",
        "why it is harmless": survivors["why"].replace("", "a gap in the tests"),
    })  # fmt: skip
    shown = shown.replace({r"\|": r"\\|"}, regex=True)
    return (
        "# Mutants\n\nThe code with one small change each, and whether a test fails (`make mutants`).\n\n"
        f"{counts.to_markdown()}\n\n## Survivors\n\n{shown.to_markdown(index=False)}\n"
    )


def main() -> None:
    """Draw, run, report."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--number", type=int, default=320, help="mutants, about [%(default)s]")
    parser.add_argument("--seed", type=int, default=1, help="of the draw [%(default)s]")
    parser.add_argument("--seconds", type=float, default=15.0, help="of tests [%(default)s]")
    parser.add_argument("--jobs", type=int, default=2, help="mutants at a time [%(default)s]")
    parser.add_argument("--work", type=Path, help="folder that keeps what is done, to go on there")
    options = parser.parse_args()
    harmless = read_harmless()
    mutants = sample(options.number, options.seed)
    with tempfile.TemporaryDirectory() as temporary:
        folder = (options.work or Path(temporary)).resolve()
        tests = Tests(folder, options.jobs)
        known = folder / "outcomes.jsonl"
        done = dict(map(json.loads, known.open())) if known.exists() else {}

        def row(mutant: Mutant) -> dict[str, str | None]:
            file, was, becomes = mutant.name
            key, begin = f"{file}: {was} -> {becomes}", time.monotonic()
            if key not in done:
                done[key] = tests.outcome(mutant, options.seconds)
                with known.open("a") as file_of_outcomes:
                    file_of_outcomes.write(json.dumps([key, done[key]]) + "\n")
                print(f"{time.monotonic() - begin:4.0f} s  {done[key]}: {key}", flush=True)
            came, why = done[key], harmless.get(mutant.name, "")
            return {"room": room_of(file), "file": file, "was": was, "becomes": becomes} | {
                "came": came, "why": why,
            }  # fmt: skip

        with ThreadPoolExecutor(options.jobs) as pool:
            table = pd.DataFrame(pool.map(row, mutants))
    table.to_csv(TABLE, index=False, lineterminator="\n")
    text = report(table)
    TABLE.with_suffix(".md").write_text(text, "utf-8")
    print(text)
    survived, listed = table["came"] == "survived", table["why"] != ""
    if (survived != listed).any():
        sys.exit(
            f"{(survived & ~listed).sum()} survivors without a reason, "
            f"{(listed & ~survived).sum()} listed as harmless and killed"
        )


if __name__ == "__main__":
    main()
