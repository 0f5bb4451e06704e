"""Problems of one's own, with variable coefficients, transport and sources:

u_t + div(a(x,t) u) = div(D(x,t) grad^beta u) + f(x,t,u),    div grad^beta = -(-Laplacian)^(alpha/2).
"""

from __future__ import annotations

from fracparticles.problems.problem import Problem
from fracparticles.problems.solve import solve_problem

__all__ = ["Problem", "solve_problem"]
