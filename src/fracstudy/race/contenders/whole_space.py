"""Ours for problems with one symbol: the exact symbol with tails in closed form, judged (`fp.evolve`) or not."""

from __future__ import annotations

from fracparticles.arguments import finite_array
from fracparticles.time.whole_space import WholeSpace
from fracstudy.race.contender import Contender, Ready, Solve, Trials, lattices, sweep
from fracstudy.race.problem import Problem, lattice

_TRUNCATIONS = (1.5, 2.2, 3.0, 4.1, 5.0, 8.0, 12.0, 20.0)


class Unjudged(Contender):
    """`fracparticles.WholeSpace.solve`, which like the peers does not estimate its errors."""

    name, label = "WholeSpace", "fp.WholeSpace (exact symbol, tails continued)"
    reference = "this library"
    group, place, dims = "ours", 0, (1, 2, 3)
    colour, marker = "#7B3294", "v"

    def trials(self, problem: Problem) -> Trials:
        """Yield the lattices of the exact symbol without terms, and smaller ones with terms."""
        yield from sweep(lattices(problem), variant="0 terms", terms=0)
        for terms in (1, 2, 4) if problem.dim == 1 else (1, 2):
            few = lattices(problem, truncations=_TRUNCATIONS)
            yield from sweep(few, variant=f"{terms} terms", terms=terms)

    def prepare(
        self, problem: Problem, variant: str, points: int, half_width: float, terms: int
    ) -> Ready:
        """Return the run made ready."""
        dim, h = problem.dim, 2.0 * half_width / points
        tau = problem.time * h**-problem.alpha
        run = WholeSpace(points, dim, problem.alpha, tau, terms=terms, tail=problem.tail)
        return Ready(lattice(points, half_width, dim), h**dim, self._solve(run), batched=True)

    def _solve(self, run: WholeSpace) -> Solve:
        return run.solve


class Evolve(Unjudged):
    """`fracparticles.evolve`: the same run, with estimates of the errors by tail and lattice, and warnings of them."""

    name, label = "evolve", "fp.evolve (the same, judged)"
    follows = Unjudged.name
    colour, marker = "#B07CC6", "o"

    def _solve(self, run: WholeSpace) -> Solve:
        return lambda u0: run.solve_and_judge(finite_array("u", u0))[0]  # as `evolve` does
