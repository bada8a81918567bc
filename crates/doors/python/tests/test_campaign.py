"""Campaigns and sweeps: here, in shards, on a cluster, broken off and resumed."""

from __future__ import annotations

import csv
import math
import os
import pickle
import signal
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import raypencil
from conftest import SMALL, Command

DRIVE = SMALL + "[drive]\nwaypoints_m = [[0.4, 0]]\nframes_per_s = 3\nscans = false\n"


def summary(folder: Path) -> bytes:
    return (folder / "summary.json").read_bytes()


def test_a_campaign_is_that_of_the_command(tmp_path: Path, command: Command) -> None:
    heard: list[str] = []
    found = raypencil.campaign(3, seed=2, output=tmp_path / "mine", progress=heard.append)
    command("campaign", "--terrains", 3, "--seed", 2, "-o", "theirs")
    assert summary(tmp_path / "mine") == summary(tmp_path / "theirs")
    assert found.passes and bool(found) and "3 terrains of seed 2" in str(found)
    assert found.counts["agree"] > 1000 and found.counts["defects"] == 0 and found.wrong == []
    assert heard[-1] == "3 of 3 terrains"
    assert repr(found) == "<raypencil.CampaignResult: 3 terrains, agree>"
    assert pickle.loads(pickle.dumps(found)).summary == found.summary
    # In shards, one of which was there before.
    raypencil.campaign(3, seed=2, output=tmp_path / "shards", shards=3)
    assert summary(tmp_path / "shards") == summary(tmp_path / "mine")


def test_a_campaign_over_scenes_of_ones_own_hunts_in_a_program(tmp_path: Path) -> None:
    scenes = tmp_path / "scenes"
    scenes.mkdir()
    (scenes / "small.toml").write_text(SMALL)
    program = tmp_path / "program.py"
    program.write_text(
        "import sys, raypencil\n"
        "scene = raypencil.load(sys.argv[1] + '/scene.toml')\n"
        "import numpy as np, os\n"
        "for sensor, maps in raypencil.render(scene, 'tracer').items():\n"
        "    os.makedirs(f'{sys.argv[2]}/{sensor}', exist_ok=True)\n"
        "    np.save(f'{sys.argv[2]}/{sensor}/range.T.npy', maps['range'] * float(sys.argv[3]))\n"
    )
    run = f"{sys.executable} {program} {{pack}} {{out}}"
    right = raypencil.campaign(scenes=scenes, output=tmp_path / "right", candidate_command=f"{run} 1")
    assert right.passes and right.summary["parts"]["own"]["compared"] > 1000, str(right)
    wrong = raypencil.campaign(scenes=scenes, output=tmp_path / "wrong", candidate_command=f"{run} 1.001")
    assert not wrong and wrong.counts["defects"] > 500
    assert list((tmp_path / "wrong" / "misses").rglob("manifest.json"))


def test_campaigns_that_make_no_sense(tmp_path: Path) -> None:
    with pytest.raises(raypencil.RaypencilError, match="expected at least 1"):
        raypencil.campaign(0, output=tmp_path)
    with pytest.raises(raypencil.RaypencilError, match="expected 1 to 3"):
        raypencil.campaign(3, shards=4, output=tmp_path)
    with pytest.raises(raypencil.RaypencilError, match="it has no {out}"):
        raypencil.campaign(3, candidate_command="x {pack}", output=tmp_path)
    with pytest.raises(raypencil.RaypencilError, match="nowhere"):
        raypencil.campaign(scenes=tmp_path / "nowhere", output=tmp_path)


def test_a_sweep_is_that_of_the_command(tmp_path: Path, command: Command) -> None:
    (tmp_path / "small.toml").write_text(SMALL)
    settings = {"beam.pitch_down_deg": [20, 30], "terrain.builtin": ["pyramids", "facets"]}
    found = raypencil.sweep(
        tmp_path / "small.toml", settings, do="render", output=tmp_path / "mine",
        charts=["beam-0.hits,beam.pitch_down_deg,terrain.builtin"],
    )  # fmt: skip
    command(
        "sweep", "small.toml", "--set", "beam.pitch_down_deg=20,30", "--set", "terrain.builtin=pyramids,facets", "--do",
        "render", "-o", "theirs",
    )  # fmt: skip
    for name in ("table.csv", "table.parquet"):
        assert (tmp_path / "mine" / name).read_bytes() == (tmp_path / "theirs" / name).read_bytes(), name
    assert found and len(found) == 4 and found.columns["terrain.builtin"] == ["pyramids", "facets"] * 2
    table = found.to_pandas()
    assert list(table.index) == [0, 1, 2, 3] and table["beam.pitch_down_deg"].tolist() == [20, 20, 30, 30]
    assert table["beam-0.flux_w"].dtype == np.float64 and (table["beam-0.flux_w"] > 0).all()
    with open(tmp_path / "mine" / "table.csv", newline="") as file:
        assert [float(row["beam-0.flux_w"]) for row in csv.DictReader(file)] == table["beam-0.flux_w"].tolist()
    charts = {path.name for path in (tmp_path / "mine" / "charts").iterdir()}
    assert "beam-0.hits-over-beam.pitch_down_deg-by-terrain.builtin.svg" in charts
    assert "beam-0.flux_w" in found._repr_html_()


def test_a_sweep_of_a_scene_object_and_of_listed_runs(tmp_path: Path) -> None:
    scene = raypencil.Scene(DRIVE, name="small").replace(**{"beam.thickness_mm": 4})
    runs = [{"drive.speed_m_per_s": 0.3}, {"drive.speed_m_per_s": 0.6, "beam.power_w": 2}]
    found = raypencil.sweep(scene, runs=runs, do="drive", output=tmp_path)
    assert found.columns["beam.thickness_mm"] == [4, 4] and found.columns["frames"] == [5, 3]
    assert found.columns["beam.power_w"] == [None, 2]
    import pandas

    again = raypencil.sweep(scene, runs=pandas.DataFrame(runs), do="drive", output=tmp_path)
    assert again.columns["frames"] == [5, 3]
    # A run that its ground refuses says why, and the others are there.
    some = raypencil.sweep(scene, {"vehicle.position_m": [[0, 0], [1e5, 0]]}, do="render", output=tmp_path / "b")
    assert not some and some.columns["refused"][0] is None and "no ground" in some.columns["refused"][1]


@pytest.mark.parametrize(
    "settings", [{"beam.power_w": [1, -1]}, {"nokey": [1]}, {"beam.0.pitch_down_deg": ["20:35:5"]}, {"beam.power_w": [math.nan]}]
)
def test_a_sweep_of_values_that_no_scene_takes_is_refused_before_its_work(settings: dict[str, Any], tmp_path: Path) -> None:
    key = next(iter(settings)).rsplit(".", 1)[-1]
    with pytest.raises(raypencil.RaypencilError, match=key):
        raypencil.sweep("pyramids", settings, do="render", output=tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_sweeps_that_make_no_sense(tmp_path: Path) -> None:
    with pytest.raises(raypencil.RaypencilError, match="expected validate, render or drive"):
        raypencil.sweep("pyramids", do="dance", output=tmp_path)  # type: ignore[arg-type]
    with pytest.raises(raypencil.RaypencilError, match="there is no renderer"):
        raypencil.sweep("pyramids", do="render", with_="mitsuba", output=tmp_path)
    with pytest.raises(raypencil.RaypencilError, match="is no key"):
        raypencil.sweep("pyramids", {"a b": 1}, do="render", output=tmp_path)
    with pytest.raises(raypencil.RaypencilError, match="runs is empty"):
        raypencil.sweep("pyramids", runs=[], output=tmp_path)


@pytest.fixture
def cluster() -> Iterator[Any]:
    """Two workers, each a process of its own."""
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None, worker_dashboard_address=None
    ) as made:
        yield made


def kill_one(client: Any) -> None:
    """Kills a worker by its process number."""
    pids = list(client.run(os.getpid).values())
    assert len(set(pids)) == 2
    os.kill(pids[0], signal.SIGKILL)


def test_a_cluster_gives_the_same_bytes_though_a_worker_is_killed(tmp_path: Path, cluster: Any) -> None:
    from distributed import Client

    here = raypencil.campaign(8, seed=2, output=tmp_path / "here")
    with Client(cluster) as client:
        killed: list[str] = []

        def kill_after_the_first(stage: str) -> None:
            if not killed:
                kill_one(client)
            killed.append(stage)

        there = raypencil.campaign(
            8, seed=2, output=tmp_path / "there", client=client, shards=8, progress=kill_after_the_first
        )
        assert len(killed) == 8
        assert summary(tmp_path / "there") == summary(tmp_path / "here") and there.text == here.text
        # Resumed with nothing missing: no task at all.
        again: list[str] = []
        raypencil.campaign(8, seed=2, output=tmp_path / "there", client=client, shards=8, progress=again.append)
        assert again == []

        (tmp_path / "small.toml").write_text(SMALL)
        swept = {"camera.pitch_down_deg": [10, 20, 30], "beam.thickness_mm": [4, 8]}
        scene = tmp_path / "small.toml"
        raypencil.sweep(scene, swept, do="render", output=tmp_path / "s-here")
        raypencil.sweep(scene, swept, do="render", output=tmp_path / "s-there", client=client, shards=3)
        table = (tmp_path / "s-here" / "table.csv").read_bytes()
        assert (tmp_path / "s-there" / "table.csv").read_bytes() == table


def test_a_scheduler_is_restarted_and_the_campaign_resumed(tmp_path: Path, command: Command) -> None:
    distributed = pytest.importorskip("distributed")
    expected = raypencil.campaign(6, seed=2, output=tmp_path / "here")
    options = {"n_workers": 2, "threads_per_worker": 1, "dashboard_address": None}

    class Enough(Exception):
        pass

    def two(stage: str) -> None:
        if stage.startswith("2 of"):
            raise Enough

    with distributed.LocalCluster(**options) as first, distributed.Client(first) as client, pytest.raises(Enough):
        raypencil.campaign(6, seed=2, output=tmp_path / "there", client=client, shards=6, progress=two)
    done = len(list((tmp_path / "there").glob("shard-*.json")))
    assert 2 <= done < 6
    # A damaged one is made again.
    damaged = next(iter(sorted((tmp_path / "there").glob("shard-*.json"))))
    damaged.write_bytes(damaged.read_bytes()[:-40])
    with distributed.LocalCluster(**options) as second:
        words = ("campaign", "--terrains", 6, "--seed", 2, "--shards", 6, "-o", "there")
        done_now = command(*words, "--dask", second.scheduler_address)
    assert summary(tmp_path / "there") == summary(tmp_path / "here")
    assert done_now.stdout == expected.text


def test_the_command_on_a_cluster_names_what_is_wrong(tmp_path: Path, command: Command) -> None:
    pytest.importorskip("distributed")
    done = command("campaign", "--dask", "tcp://127.0.0.1:1", code=2)
    assert "127.0.0.1:1" in done.stderr


def test_all_units_of_work_are_in_some_shard(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from raypencil import _cluster

    made: list[list[int]] = []
    monkeypatch.setattr(_cluster, "_on_cluster", lambda client, name, wanted, *_: made.append(wanted))
    for count, of_a_shard, shards in ((5, 2, 3), (4, 2, 2), (1, 8, 1)):
        has = lambda index, shards, folder: index == 1  # noqa: E731
        work = _cluster.Work("x", "runs", count, of_a_shard, lambda *_: None, has, lambda *_: {})
        _cluster.run_shards(work, None, str(tmp_path), object(), 0, False)
        # The second one is there already.
        assert made.pop() == [index for index in range(shards) if index != 1]
