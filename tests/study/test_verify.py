"""`make verify`: the sample, and what counts as agreement."""

from __future__ import annotations

import pytest

from fracstudy.verify import CLOSE, DIFFERS, SAME, agreement, compare, sample
from scene_functions import configured


@pytest.mark.parametrize("seed", range(5))
def test_the_sample_has_a_scene_of_each_document_and_no_run_times(seed):
    scenes = configured()[1]
    names = sample(scenes, 10, seed)
    assert len(set(names)) == 10
    alone = [s for s in scenes.values() if not s.all_benchmarks and not s.tables]
    assert {scene.document for scene in alone} == {scenes[name].document for name in names}
    assert not any(scenes[name].all_benchmarks for name in names)
    assert sample(scenes, 10, seed) == names


@pytest.mark.parametrize(
    ("tracked", "made", "found"),
    [
        ("a,b\nDD,1.5\n", "a,b\nDD,1.5\n", SAME),
        ("a,b\nDD,1.5\n", "a,b\nDD,1.5000000001\n", CLOSE),
        ("a,b\nDD,3e-14 of the peak\n", "a,b\nDD,4e-14 of the peak\n", CLOSE),
        ("a,b\nDD,1.5\n", "a,b\nDD,1.501\n", DIFFERS),
        ("a,b\nDD,held\n", "a,b\nDD,silent\n", DIFFERS),
        ("a,b\nDD,1.5\n", "a,b\nDD,1.5\nKPSE,2\n", DIFFERS),
    ],
)
def test_tables_agree_to_round_off(tracked, made, found):
    assert agreement(tracked, made) == found


def test_a_figure_must_agree_where_its_table_does(tmp_path):
    for side in ("tracked", "made"):
        (tmp_path / side / "tables").mkdir(parents=True)
        (tmp_path / side / "figures").mkdir()
        for name in ("one", "two"):
            (tmp_path / side / f"tables/{name}.csv").write_text("x\n1.0\n")
            (tmp_path / side / f"figures/{name}.svg").write_text("<svg/>")
    (tmp_path / "made/figures/two.svg").write_text("<svg></svg>")
    table = compare(["one", "two"], tmp_path / "tracked", tmp_path / "made")
    assert list(table["agreement"]) == [SAME, SAME, SAME, DIFFERS]
