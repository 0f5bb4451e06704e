"""Draw cases of a property again, and show what comes of them.

    PYTHONPATH=workflow python -m scenes.extremes.fuzzing.again "a run, linear" 17
    PYTHONPATH=workflow python -m scenes.extremes.fuzzing.again "a run, linear" 1000000 5000

With one number that is the case of a seed, drawn, shown and run with its traceback. With two it is a hunt: so many
seeds from the first on, of which the bad ones are shown. "all" hunts in every property.
"""

import sys
import time
import warnings

from scenes.extremes.fuzzing.harness import draw, outcome, row
from scenes.extremes.fuzzing.study import PROPERTIES


def main(name: str, first: int, count: int | None = None) -> None:
    """Run the case of a seed, or those of `count` seeds."""
    known = {one.name: one for one in PROPERTIES}
    if name != "all" and name not in known:
        sys.exit(f"{name!r} is none of {', '.join(known)}")
    if count is None:
        case = draw(known[name], first)
        print(case)
        print(outcome(known[name], first))
        warnings.simplefilter("error", RuntimeWarning)
        print(known[name].holds(case), "of what is allowed")
        return
    for one in PROPERTIES if name == "all" else [known[name]]:
        began = time.perf_counter()
        _, counts = row(one, count, first)
        print(f"{one.name}: {counts}, {time.perf_counter() - began:.1f} s", flush=True)


if __name__ == "__main__":
    main(sys.argv[1], *map(int, sys.argv[2:]))
