"""Methods of the literature for u_t = -(-Laplacian)^(alpha/2) u on the real line, to measure ours against.

One small module each, written from the published formula, with a `PEER`; it is found by its file.

    solver = peer("sinc-lattice").prepare(alpha=1.5, half_width=40.0, spacing=0.2, time=1.0)
    u = solver.solve(u0(solver.x))

`prepare` does all that does not depend on the initial data, `prepare_plane` the same in the plane for those that exist
there. They share `lattice` and `plane`: those on a lattice are Toeplitz matrices, and so have a lattice sum and a
Chebyshev series in time as our schemes have.
"""

from __future__ import annotations

from importlib import import_module
from pkgutil import iter_modules

from fracparticles.errors import InvalidInput
from fracstudy.peers.base import Peer, PlaneSolver, Solver

__all__ = ["PEERS", "PLANE_PEERS", "Peer", "PlaneSolver", "Solver", "peer"]

_modules = [import_module(f"{__name__}.{module.name}") for module in iter_modules(__path__)]
_found: list[Peer] = [module.PEER for module in _modules if hasattr(module, "PEER")]

PEERS = {one.name: one for one in sorted(_found, key=lambda one: one.place)}
PLANE_PEERS = {name: one for name, one in PEERS.items() if one.make_plane is not None}


def peer(name: str) -> Peer:
    """Return the peer of that name.

    Raises
    ------
    InvalidInput
        If there is none.
    """
    if isinstance(name, str) and name in PEERS:
        return PEERS[name]
    raise InvalidInput("peer", name, f"one of {', '.join(PEERS)}", "Choose one of these names.")
