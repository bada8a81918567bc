"""Drives: each frame is that of the command's recording, bit for bit; and a drive can be given up."""

from __future__ import annotations

import csv
import json
import threading
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import Command, same_bits
from test_validate import without_times

import raypencil
from raypencil import RaypencilError, Scene, drive

#: 0.6 m in 7 frames, with a vertical scan of 5 stripes at the start.
SHORT = """version = 1
vehicle = { position_m = [-0.6, 0] }
camera = { width_px = 96, height_px = 72, pixel_pitch_um = 96 }
beam = [{ rows = 2 }, { rows = 2 }]
terrain = { builtin = "pyramids" }
drive = { waypoints_m = [[0.6, 0]], frames_per_s = 3, scan_steps = 5, obstacles_every_frames = 3 }
"""


@pytest.mark.parametrize("change", ["", ", sensor = 'cmos'", ", subtract_unlit = true", ", exposures = 'together'"])
def test_frames_are_those_of_the_commands_recording(command: Command, tmp_path: Path, change: str) -> None:
    text = SHORT[:-3] + change + " }\n"
    (tmp_path / "short.toml").write_text(text)
    command("drive", "short.toml", "--record", "npy,points,maps", "-o", "theirs")
    recording = tmp_path / "theirs/recording"
    frames = list(drive(Scene(text, name="short")))
    assert [frame.index for frame in frames] == list(range(7))
    assert same_bits(np.concatenate([frame.stripes for frame in frames]), np.load(recording / "stripes.npy"))
    assert same_bits(np.concatenate([frame.points for frame in frames]), np.load(recording / "points.npy"))
    with open(recording / "poses.csv") as file:
        poses = list(csv.DictReader(file))
    parts = ["x_m", "y_m", "z_m", "qx", "qy", "qz", "qw"]
    for frame, row in zip(frames, poses, strict=True):
        for name, pose in [("true", frame.true_pose), ("believed", frame.believed_pose)]:
            given = [float(row[f"{name}_{part}"]) for part in parts]
            assert given == [*pose.position, *pose.quaternion]
        assert (frame.time, frame.driven, frame.scan or "") == (float(row["time_s"]), float(row["driven_m"]), row["scan"])
        assert (len(frame.points), frame.columns_left_out) == (int(row["points"]), int(row["columns_left_out"]))
    images = {path.stem: np.load(path) for path in (recording / "images").glob("*.npy") if "-scan" not in path.stem}
    ours = {f"{frame.index:06}-{lit}": image for frame in frames for lit, image in frame.images.items()}
    assert sorted(images) == sorted(ours)
    assert all(same_bits(ours[name], image) for name, image in images.items())
    with open(recording / "maps.csv") as file:
        maps = {int(row["frame"]): row for row in csv.DictReader(file)}
    assert sorted(maps) == [0, 3, 6] == [frame.index for frame in frames if frame.sectors is not None]
    for index, row in maps.items():
        of = frames[index].map
        assert same_bits(of.elevation, np.load(recording / f"maps/{index:06}-elevation.npy"))
        assert same_bits(of.source, np.load(recording / f"maps/{index:06}-source.npy"))
        assert (of.west, of.south, of.spacing) == (float(row["west_m"]), float(row["south_m"]), float(row["spacing_m"]))
    for name, columns in [
        ("sectors", ["direction_rad", "radius_m", "x_m", "y_m"]),
        ("vectors", ["from_x_m", "from_y_m", "to_x_m", "to_y_m"]),
    ]:
        with open(recording / f"{name}.csv") as file:
            rows = list(csv.DictReader(file))
        told = [getattr(frame, name) for frame in frames if getattr(frame, name) is not None]
        assert [[float(row[column]) for column in columns] for row in rows] == np.concatenate([of.ends for of in told]).tolist()
        assert [row["label"] for row in rows] == [label for of in told for label in of.labels]


def test_a_drives_folder_is_the_commands(command: Command, tmp_path: Path) -> None:
    (tmp_path / "short.toml").write_text(SHORT)
    command("drive", "short.toml", "--both", "--to", "0.3,0", "--record", "points", "-o", "theirs")
    driven = drive(
        Scene(SHORT, name="short"), to=(0.3, 0), with_=("scanline", "tracer"), record=["points"], output=tmp_path / "ours"
    )
    with pytest.raises(RaypencilError, match="has not ended"):
        driven.summary  # noqa: B018
    assert len(list(driven)) == 4 == driven.planned and driven.passes and "over 4 frames" in driven.text
    theirs, ours = (json.loads((tmp_path / name / "summary.json").read_text()) for name in ("theirs", "ours"))
    assert without_times(theirs) == without_times(ours) == without_times(driven.summary)
    assert (tmp_path / "ours/recording/points.npy").read_bytes() == (tmp_path / "theirs/recording/points.npy").read_bytes()
    assert next(driven, None) is None


def test_printed_rules_and_another_renderer(command: Command, tmp_path: Path) -> None:
    (tmp_path / "short.toml").write_text(SHORT)
    command("drive", "short.toml", "--as-printed", "--with", "tracer", "--rule", "gap=mended", "--record", "points,npy", "-o", "theirs")
    frames = list(drive(Scene(SHORT), as_printed=True, with_="tracer", rules={"gap": "mended"}))
    points = np.concatenate([frame.points for frame in frames])
    assert same_bits(points, np.load(tmp_path / "theirs/recording/points.npy"))
    image = frames[3].images["all"]
    assert image.dtype == np.float64 and same_bits(image, np.load(tmp_path / "theirs/recording/images/000003-all.npy"))


def test_images_may_be_left_out() -> None:
    frames = list(drive(Scene(SHORT), to=(0.2, 0), images=False))
    assert all(frame.images == {} for frame in frames) and frames[0].scan == "start" and len(frames[1].points) > 0


@pytest.mark.parametrize("to", ["1,0", [(1, 0), (2,)], [None, 1], (1, float("nan"))])
def test_waypoints_that_are_none_are_named(to: Any) -> None:
    with pytest.raises(RaypencilError, match=r"^to is .*; expected waypoints of two numbers, such as \[\(3, 0\), \(3, 2\)\]"):
        drive(Scene(SHORT), to=to)


def test_a_frame_has_units_and_is_read_only() -> None:
    pytest.importorskip("xarray")
    *_, frame = drive(Scene(SHORT), to=(0.2, 0))
    dataset = frame.map.to_xarray()
    assert dataset.elevation.dims == ("y", "x") and dataset.x.attrs["units"] == "m"
    assert np.isclose(dataset.x.values[1] - dataset.x.values[0], frame.map.spacing)
    assert frame.map._repr_png_().startswith(b"\x89PNG")
    for array in [frame.points, frame.stripes, frame.map.elevation, frame.images["beam0"], frame.true_pose.position]:
        assert not array.flags.writeable
    # Points lie where the map has them: their cell was measured.
    x, y, z = frame.points[:, 8:11].T
    row = np.rint((y - frame.map.south) / frame.map.spacing).astype(int)
    column = np.rint((x - frame.map.west) / frame.map.spacing).astype(int)
    assert (frame.map.source[row, column] == 3).all() and np.abs(frame.map.elevation[row, column] - z).max() < 0.2


def _name_of(task: str) -> str:
    try:
        return Path(f"/proc/self/task/{task}/comm").read_text()
    except (FileNotFoundError, ProcessLookupError):
        # It has ended since it was listed.
        return ""


def raypencil_threads() -> int:
    # The threads of a drive; those of the pool are named after who called first.
    return sum("raypencil " in _name_of(task) for task in _tasks())


def _tasks() -> list[str]:
    return [path.name for path in Path("/proc/self/task").iterdir()] if Path("/proc/self/task").is_dir() else []


@pytest.mark.skipif(not Path("/proc/self/task").is_dir(), reason="needs /proc")
def test_a_drive_can_be_given_up(tmp_path: Path, cube: raypencil.Mesh) -> None:
    # The engine's pool takes its name from the first call that needs it: not from a drive.
    raypencil.cast(cube, np.ones((1000, 6)))
    before = raypencil_threads()
    with drive("pyramids", output=tmp_path / "out") as driven:
        next(driven)
        time.sleep(0.5)
        # It waits for us: 251 frames would be done by then, or be in memory.
        assert driven.planned == 251 and raypencil_threads() > before
    other = drive("pyramids")
    next(other)
    del other
    for _ in range(100):
        if raypencil_threads() == before:
            break
        time.sleep(0.1)
    assert raypencil_threads() == before
    assert list(driven) == [] and not (tmp_path / "out/summary.json").exists()


def test_progress_is_told() -> None:
    said: list[str] = []
    drive(Scene(SHORT), to=(0.2, 0), progress=said.append).run()
    assert said == ["frame 1 of 3", "frame 2 of 3", "frame 3 of 3"]


@pytest.mark.parametrize(
    ("scene", "options", "words"),
    [
        (Scene("version = 1\n"), {}, "there is no drive"),
        (Scene(SHORT), {"to": (500, 0)}, "the route"),
        (Scene(SHORT), {"to": [1, 2, 3]}, "expected waypoints of two numbers"),
        (Scene(SHORT), {"rules": {"gap": "real"}}, "rule gap=real"),
        (Scene(SHORT), {"record": ["films"], "output": "x"}, "record films: expected images"),
        (Scene(SHORT), {"record": ["points"]}, "record needs output"),
        (Scene(SHORT), {"with_": ["scanline", "tracer", "referee"]}, "expected one renderer, or two"),
        (Scene(SHORT), {"with_": "mitsuba"}, "no renderer"),
    ],
)
def test_what_is_wrong_is_named(scene: Scene, options: dict[str, object], words: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(RaypencilError, match=words):
        drive(scene, **options).run()  # type: ignore[arg-type]


def test_frames_may_be_taken_by_another_thread() -> None:
    driven = drive(Scene(SHORT), to=(0.2, 0))
    taken: list[raypencil.Frame] = []
    thread = threading.Thread(target=lambda: taken.extend(driven))
    thread.start()
    thread.join(60)
    assert [frame.index for frame in taken] == [0, 1, 2]


def test_stripes_of_ones_own(command: Command, tmp_path: Path) -> None:
    (tmp_path / "short.toml").write_text(SHORT)
    command("drive", "short.toml", "--record", "npy,points", "-o", "own")
    recording = tmp_path / "own/recording"
    rows = np.load(recording / "stripes.npy")
    # Every second edge: another drive than with the rover's own.
    half = tmp_path / "half"
    half.mkdir()
    np.save(half / "stripes.npy", rows[::2])
    command("drive", "short.toml", "--stripes", "half", "--record", "points", "-o", "theirs")
    expected = np.load(tmp_path / "theirs/recording/points.npy")
    assert 0 < len(expected) < len(np.load(recording / "points.npy"))
    scene = Scene(SHORT, name="short")
    given: list[Any] = [half, str(half), rows[::2], rows[::2].tolist()]
    for stripes in given:
        frames = list(drive(scene, stripes=stripes, images=False))
        assert same_bits(np.concatenate([frame.points for frame in frames]), expected)
    # The rover's own, from a recording and from its frames.
    frames = list(drive(scene, images=False))
    of_frames = np.concatenate([frame.stripes for frame in frames])
    again = list(drive(scene, stripes=of_frames, images=False))
    assert same_bits(np.concatenate([frame.points for frame in again]), np.load(recording / "points.npy"))
    with pytest.raises(RaypencilError, match=r"stripes have the shape \(3, 4\); expected \(n, 5\)"):
        drive(scene, stripes=np.zeros((3, 4)))
    with pytest.raises(RaypencilError, match=r"row 1, frame.*expected a whole number"):
        drive(scene, stripes=np.array([[0, -1, 0, 3, 4], [0.5, -1, 0, 3, 4]]))
    with pytest.raises(RaypencilError, match="lies in the output"):
        drive(scene, stripes=recording, output=tmp_path / "own")
    with pytest.raises(FileNotFoundError):
        drive(scene, stripes=tmp_path / "nowhere")
