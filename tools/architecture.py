"""docs/architecture.svg: the rooms of the library, floor above floor, and which room imports from which.

    python tools/architecture.py > docs/architecture.svg

The floors are those of the contract in `pyproject.toml`, the arrows those of the source.
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping, Sequence
from html import escape
from importlib import import_module
from pathlib import Path

import grimp

__all__ = ["drawing", "floors", "imports"]

_LIBRARY = "fracparticles"
_WIDTH, _FLOOR, _BOX = 900, 120, (190, 56)
_COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00", "#666666")


def floors(project: Path) -> list[list[str]]:
    """Return the rooms of each floor, the uppermost first, as the linter's contract names them."""
    contracts = tomllib.loads((project / "pyproject.toml").read_text("utf-8"))["tool"][
        "importlinter"
    ]
    (layers,) = (c["layers"] for c in contracts["contracts"] if c["type"] == "layers")
    return [floor.split(" | ") for floor in layers]


def imports() -> dict[str, set[str]]:
    """Return the rooms from which each room imports."""
    graph = grimp.build_graph(_LIBRARY)
    rooms = graph.find_children(_LIBRARY) - {f"{_LIBRARY}.__main__"}  # no room, but the door
    found = {}
    for room in rooms:
        members = graph.find_descendants(room) | {room}
        imported = set().union(*(graph.find_modules_directly_imported_by(m) for m in members))
        found[_short(room)] = {_short(name) for name in imported} - {_short(room), ""}
    return found


def _short(module: str) -> str:
    """The room of a module: "lattice" of "fracparticles.lattice.sums"."""
    return module.removeprefix(_LIBRARY).strip(".").partition(".")[0]


def drawing(layers: Sequence[Sequence[str]], arrows: Mapping[str, set[str]]) -> str:
    """Return the drawing as SVG.

    Parameters
    ----------
    layers : sequence of sequence of str
        The rooms of each floor, the uppermost first. From the last two all others import: no arrows lead there.
    arrows : mapping
        The rooms from which each room imports.
    """
    upper, ground = layers[:-2], [room for floor in layers[-2:] for room in floor]
    place = {
        room: (_WIDTH * (k + 0.5) / len(floor) + _aside(level, floor), 50 + _FLOOR * level)
        for level, floor in enumerate(upper)
        for k, room in enumerate(floor)
    }
    height = 50 + _FLOOR * len(upper) + 30
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {_WIDTH} {height}" font-family="sans-serif" '
        'font-size="15" text-anchor="middle">',
        f'<rect width="{_WIDTH}" height="{height}" fill="white"/>',
    ]
    for k, room in enumerate(place):
        colour = _COLOURS[k % len(_COLOURS)]
        for other in sorted(arrows[room] & place.keys()):
            parts.append(_arrow(place[room], place[other], colour, f"{room} imports from {other}"))
    for k, (room, (x, y)) in enumerate(place.items()):
        colour = _COLOURS[k % len(_COLOURS)]
        purpose = (import_module(f"{_LIBRARY}.{room}").__doc__ or "").partition("\n")[0]
        parts.append(
            f'<g><title>{escape(purpose)}</title><rect x="{x - _BOX[0] / 2:g}" y="{y - _BOX[1] / 2:g}" '
            f'width="{_BOX[0]}" height="{_BOX[1]}" rx="6" fill="white" stroke="{colour}" stroke-width="2"/>'
            f'<text x="{x:g}" y="{y + 5:g}">{room}</text></g>'
        )
    y = height - 50
    parts.append(
        f'<rect x="20" y="{y - 22}" width="{_WIDTH - 40}" height="44" rx="6" fill="#eeeeee"/>'
        f'<text x="{_WIDTH / 2:g}" y="{y + 5}">for all: {", ".join(ground)}</text></svg>'
    )
    return "\n".join(parts) + "\n"


def _aside(level: int, floor: Sequence[str]) -> float:
    """A room alone on its floor stands to one side, so that arrows pass it."""
    return (130.0 if level % 2 else -130.0) if len(floor) == 1 else 0.0


def _arrow(
    source: tuple[float, float], target: tuple[float, float], colour: str, title: str
) -> str:
    """A curve from the lower edge of a box to the upper edge of another, with a head."""
    (x0, y0), (x1, y1) = source, target
    shift = 0.25 * _BOX[0] * (1 if x1 > x0 else -1 if x1 < x0 else 0)
    x0, x1 = x0 + shift, x1 - shift
    y0, y1 = y0 + _BOX[1] / 2, y1 - _BOX[1] / 2
    bend = 0.5 * (y1 - y0)
    return (
        f'<g stroke="{colour}" fill="none" opacity="0.75"><title>{title}</title>'
        f'<path d="M{x0:g} {y0:g}C{x0:g} {y0 + bend:g} {x1:g} {y1 - bend:g} {x1:g} {y1 - 7:g}"/>'
        f'<path d="M{x1 - 4:g} {y1 - 8:g}L{x1:g} {y1:g}L{x1 + 4:g} {y1 - 8:g}Z" fill="{colour}"/></g>'
    )


if __name__ == "__main__":
    project = Path(__file__).resolve().parents[1]
    print(drawing(floors(project), imports()), end="")
