"""The drawing of the architecture is that of the source."""

from __future__ import annotations

from pathlib import Path

from architecture import drawing, floors, imports

ROOT = Path(__file__).resolve().parents[1]


def test_the_drawing_is_that_of_the_imports():
    text = (ROOT / "docs/architecture.svg").read_text("utf-8")
    made = drawing(floors(ROOT), imports())
    assert text == made, "python tools/architecture.py > docs/architecture.svg"


def test_every_room_has_a_floor_and_imports_from_lower_ones_only():
    level = {room: k for k, floor in enumerate(floors(ROOT)) for room in floor}
    arrows = imports()
    assert level.keys() == arrows.keys()
    assert len(arrows["run"]) > 5
    for room, others in arrows.items():
        assert all(level[room] < level[other] for other in others), room
