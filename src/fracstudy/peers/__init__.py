"""Methods of the literature for u_t = -(-Laplacian)^(alpha/2) u on the real line, to measure ours against.

One small module each, written from the published formula. A peer module offers what `base.Peer` lists:

    solver = peer("sinc-lattice").prepare(alpha=1.5, half_width=40.0, spacing=0.2, time=1.0)
    u = solver.solve(u0(solver.x))

`prepare` does all that does not depend on the initial data. They share `lattice`: those on a lattice are Toeplitz
matrices, and so have a lattice sum and a Chebyshev series in time as our schemes have.
"""

from __future__ import annotations

from fracparticles.errors import InvalidInput
from fracstudy.peers import (
    duo_wyk_zhang,
    exact_symbol,
    fractional_centred,
    huang_oberman,
    mapped_fourier,
    sinc_lattice,
)
from fracstudy.peers.base import Peer, Solver

__all__ = ["PEERS", "Peer", "Solver", "peer"]

PEERS: dict[str, Peer] = {
    module.NAME: module
    for module in (
        huang_oberman,
        duo_wyk_zhang,
        fractional_centred,
        sinc_lattice,
        mapped_fourier,
        exact_symbol,
    )
}


def peer(name: str) -> Peer:
    """Return the peer of that name.

    Raises
    ------
    InvalidInput
        If there is none.
    """
    try:
        return PEERS[name]
    except (KeyError, TypeError):
        raise InvalidInput(
            "peer", name, f"one of {', '.join(PEERS)}", "Choose one of these names."
        ) from None
