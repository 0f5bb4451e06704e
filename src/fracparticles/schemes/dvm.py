"""The diffusion velocity method (DVM) as a scheme: its particles move, see `moving.dvm`."""

from __future__ import annotations

NAME = "DVM"
TITLE = "Diffusion velocity method"
EQUATION = "Eqs. (42)-(45)"
KERNEL = "Eqs. (8), (9), (20), (21)"
ORDERS: tuple[int, ...] = (2, 4)
BOX_ORDERS: tuple[int, ...] = ()
FAMILIES: tuple[str, ...] = ()
DIMS: tuple[int, ...] = (1,)
EXTERIORS: tuple[str, ...] = ("truncated",)
CONSERVATIVE = True
