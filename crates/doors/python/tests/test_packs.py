"""Packs: the command's files, and its verdicts on arrays and folders."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import DATA, SMALL, Command, random_rays, same_bits

import raypencil
from raypencil import Mesh, RaypencilError, Scene, cast, check, pack, pack_rays, render

HARD = DATA / "packs/hard"


def files(folder: Path) -> dict[str, bytes]:
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def test_a_pack_is_the_commands(command: Command, tmp_path: Path) -> None:
    (tmp_path / "small.toml").write_text(SMALL)
    command("pack", "small.toml", "-o", "theirs")
    assert pack(Scene(SMALL, name="small"), tmp_path / "ours") == tmp_path / "ours"
    theirs, ours = files(tmp_path / "theirs"), files(tmp_path / "ours")
    assert sorted(theirs) == sorted(ours) and len(ours) > 50
    differing = [name for name in theirs if theirs[name] != ours[name]]
    assert differing == []
    pack(Scene(SMALL, name="small"), tmp_path / "plain", no_bench=True)
    assert len(files(tmp_path / "plain")) < len(ours)


def test_a_pack_has_a_label_and_is_told_apart(tmp_path: Path) -> None:
    pack(Scene(SMALL, name="small"), tmp_path / "mine", no_bench=True, pack_version="2.1", licence="CC-BY-4.0")
    manifest = json.loads((tmp_path / "mine/manifest.json").read_text())
    assert (manifest["version"], manifest["licence"]) == ("2.1", "CC-BY-4.0")
    of_mine = check(tmp_path / "mine", tmp_path / "mine").summary["pack"]
    assert (of_mine["version"], of_mine["licence"], of_mine["published"]) == ("2.1", "CC-BY-4.0", False)
    sampled, every = (check(HARD, HARD, verify=verify) for verify in (False, True))
    assert every.summary["pack"]["published"]
    asked = [result.summary["verified"] for result in (sampled, every)]
    assert asked[0]["answers"] < asked[0]["of"] == asked[1]["of"] == asked[1]["answers"] == 3170
    labels: list[tuple[dict[str, Any], str]] = [({"pack_version": "one"}, "version"), ({"licence": "a\nb"}, "licence")]
    for label, words in labels:
        with pytest.raises(RaypencilError, match=words):
            pack(Scene(SMALL), tmp_path / "none", no_bench=True, **label)
    assert not (tmp_path / "none").exists()


def test_a_pack_of_rays_has_the_commands_answers(cube: Mesh, command: Command, tmp_path: Path) -> None:
    rays = random_rays(60).reshape(12, 5, 8)
    np.save(tmp_path / "rays.npy", rays)
    command("pack", DATA / "rays/cube.obj", "--rays", "rays.npy", "-o", "theirs")
    untested = pack_rays(cube, rays, tmp_path / "ours")
    for file in (tmp_path / "theirs").glob("*.npy"):
        assert file.read_bytes() == (tmp_path / "ours" / file.name).read_bytes(), file.name
    assert untested == ["ties"]


def test_a_pack_of_a_scan_is_the_commands(command: Command, cube: Mesh, tmp_path: Path) -> None:
    (tmp_path / "scan.toml").write_text(
        """
[[rays]]
name = "head"
spinning = { elevations_deg = [-30, 0, 30], steps = 40 }
poses = [{ time_s = 0, position_m = [-2, 0.5, 0.5] }, { time_s = 1, position_m = [-1, 0.5, 0.5] }]
"""
    )
    command("pack", DATA / "rays/cube.obj", "--rays", "scan.toml", "-o", "theirs")
    pack_rays(cube, tmp_path / "scan.toml", tmp_path / "ours")
    names = sorted(file.name for file in (tmp_path / "theirs").glob("*.npy"))
    assert {"time.npy", "pose.npy", "elevation.npy"} <= set(names)
    for name in names:
        assert (tmp_path / "theirs" / name).read_bytes() == (tmp_path / "ours" / name).read_bytes(), name
    # It knows its scan: a cloud in the sensor's frame is judged.
    command("cast", DATA / "rays/cube.obj", "scan.toml", "--bag", "velodyne", "-o", "cast")
    assert check(tmp_path / "ours", tmp_path / "cast/cloud-sensor.pcd", frame="sensor")
    assert not check(tmp_path / "ours", tmp_path / "cast/cloud-sensor.pcd", frame="start")
    assert check(tmp_path / "ours", tmp_path / "cast/cloud-end.pcd", frame="end")
    assert "declare --frame end" in str(check(tmp_path / "ours", tmp_path / "cast/cloud-end.pcd", frame="start").why)
    bag = tmp_path / "cast/rosbag/rosbag_0.mcap"
    assert check(tmp_path / "ours", bag, frame="sensor", topic="/points", message=1)
    with pytest.raises(RaypencilError, match="topic /points: 1 cloud, and none of number 2; expected 1 to 1"):
        check(tmp_path / "ours", bag, frame="sensor", message=2)
    with pytest.raises(RaypencilError, match=r"topic, message: .*cloud-sensor.pcd is no bag"):
        check(tmp_path / "ours", tmp_path / "cast/cloud-sensor.pcd", topic="/points")


def test_several_sets_have_a_pack_each(cube: Mesh, tmp_path: Path) -> None:
    table = '[[rays]]\nname = "{}"\nposition_m = [-3, 0.5, 0.5]\ngrid = {{ columns = 5, rows = 4, width_deg = 40, height_deg = 30 }}\n'
    (tmp_path / "two.toml").write_text(table.format("left") + table.format("right") + 'sides = "fronts"\n')
    untested = pack_rays(cube, str(tmp_path / "two.toml"), tmp_path / "packs")
    assert "t_min" in untested
    assert all((tmp_path / "packs" / name / "raypack.json").is_file() for name in ("left", "right"))
    with pytest.raises(RaypencilError, match="no-such"):
        pack_rays(cube, tmp_path / "no-such.toml", tmp_path / "none")


def test_renders_are_right_on_a_pack() -> None:
    scene = Scene(HARD / "scene.toml")
    for renderer in ("tracer", "referee"):
        result = check(HARD, render(scene, renderer))
        assert result and result.kind == "sensors" and result.why is None
    assert result.classes is None and "3,170 rays agree" in result.text


def test_arrays_are_judged_as_their_folder(tmp_path: Path, command: Command) -> None:
    camera = {path.stem: np.load(path) for path in (HARD / "camera").glob("*.npy") if not path.stem.startswith("margin")}
    wrong = np.array(camera["range.T"])
    row, column = np.argwhere(np.isfinite(wrong))[5]
    wrong[row, column] += 1e-3
    arrays: dict[str, Any] = {"camera": {**camera, "range.T": wrong}}
    result = check(HARD, arrays, name="mine", output=tmp_path / "out")
    assert not result and result.output == tmp_path / "out" and (tmp_path / "out/report.html").is_file()
    (tmp_path / "mine/camera").mkdir(parents=True)
    for name, array in arrays["camera"].items():
        np.save(tmp_path / f"mine/camera/{name}.npy", array)
    printed = json.loads(command("--json", "check", HARD, "mine", code=1).stdout)
    flat = {f"camera/{name}": array for name, array in arrays["camera"].items()}
    assert check(HARD, tmp_path / "mine").summary == printed == check(HARD, flat, name="mine").summary
    assert check(HARD, HARD).passes


def test_a_mistake_is_told() -> None:
    scene = Scene(HARD / "scene.toml")
    arrays = {key: array[::-1] for key, array in render(scene, "tracer").arrays.items()}
    result = check(HARD, arrays)
    assert not result and result.why is not None and "rows" in result.why


def test_single_precision_has_to_be_declared() -> None:
    scene = Scene(HARD / "scene.toml")
    single = {key: array.astype(np.float32) if array.dtype == float else array for key, array in render(scene, "tracer").arrays.items()}
    # Stored in single precision and computed in double is right: storage is rounded, too.
    assert check(HARD, single).passes
    off = {key: array * np.float32(1 + 3e-7) if key.endswith("range.T") else array for key, array in single.items()}
    assert not check(HARD, off).passes


def test_answers_to_a_pack_of_rays(cube: Mesh, tmp_path: Path) -> None:
    rays = random_rays(200, seed=5).reshape(40, 5, 8)
    pack_rays(cube, rays, tmp_path / "pack")
    truth = cast(cube, rays)
    result = check(tmp_path / "pack", truth)
    assert result and result.kind == "rays" and result.classes is not None and result.classes.shape == (40, 5)
    assert result.moved is not None and result.moved.shape == (40, 5, 2)
    t = np.array(truth.t)
    row, column = np.argwhere(truth.hit)[7]
    t[row, column] *= 1.5
    wrong = check(tmp_path / "pack", {"t": t}, output=tmp_path / "out")
    assert wrong.classes is not None and np.argwhere(wrong.classes == 3).tolist() == [[row, column]]
    assert "1 of 200 rays is wrong" in str(wrong) and (tmp_path / "out/report.html").is_file()
    judged = raypencil.judge(cube, rays, {"t": t})
    assert same_bits(judged.classes, wrong.classes)
    assert check(tmp_path / "pack", {"t": np.where(truth.hit, truth.t, -1)}, miss=-1).passes


def test_triangles_of_a_loader() -> None:
    folder = DATA / "packs/input"
    result = check(folder, {"triangles": np.zeros((3, 9))})
    assert not result and result.kind == "triangles"
    with pytest.raises(RaypencilError, match="is an input pack"):
        check(folder, {"triangles": np.zeros((3, 9))}, "f32")


@pytest.mark.parametrize(
    ("answers", "options", "words"),
    [
        ({"../up": np.zeros(3)}, {}, "'../up' is no name of an array"),
        ({"camera/range.T": np.zeros((3, 4))}, {}, "range.T"),
        ({"camera/range.T": np.array(["a"])}, {}, "camera/range.T is of type <U1"),
        ({"camera/range.T": np.zeros((3, 4))}, {"arithmetic": "f16"}, 'arithmetic is "f16"'),
        ({}, {"name": "a/b"}, "name is 'a/b'"),
        (7, {}, "answers are of type int"),
    ],
)
def test_what_is_wrong_is_named(answers: Any, options: dict[str, Any], words: str) -> None:
    with pytest.raises(RaypencilError, match=words):
        check(HARD, answers, **options)


def test_channels_of_other_names_and_depths_of_16_bits(tmp_path: Path, command: Command) -> None:
    depth = np.load(HARD / "camera/depth.Z.npy")
    millimetres = np.where(np.isfinite(depth), np.rint(depth * 1000), 0).astype(np.uint16)
    arrays = {"camera/z16": millimetres}
    result = check(HARD, arrays, channels={"depth.Z": "z16"}, scale=0.001)
    assert result and "agree to steps of 0.001 m" in result.text
    with pytest.raises(RaypencilError, match="holds no channel of this scene(.|\n)*channels"):
        check(HARD, arrays)
    with pytest.raises(RaypencilError, match="whole numbers; expected floating-point numbers(.|\n)*--scale"):
        check(HARD, arrays, channels={"depth.Z": "z16"})
    with pytest.raises(RaypencilError, match="scale is -1"):
        check(HARD, arrays, scale=-1)
    # The folder remembers it, for reading and comparing, too.
    (tmp_path / "mine/camera").mkdir(parents=True)
    np.save(tmp_path / "mine/camera/z16.npy", millimetres)
    note = {"format": 1, "program": "mine", "arithmetic": "f64", "channels": {"depth.Z": "z16"}, "scale": 0.001}
    (tmp_path / "mine/candidate.json").write_text(json.dumps(note))
    assert check(HARD, tmp_path / "mine").passes
    read = raypencil.read(tmp_path / "mine")["camera/depth.Z"]
    assert read.dtype == float and np.array_equal(np.isinf(read), np.isinf(depth))
    assert raypencil.diff(tmp_path / "mine", HARD, shared_only=True, fail=0.000501).passes
    assert raypencil.validate(HARD / "scene.toml", candidates=[tmp_path / "mine"]).passes


@pytest.mark.parametrize("format", ["exr-each", "npz", "zarr"])
def test_every_format_is_read(format: str, tmp_path: Path, command: Command) -> None:
    command("render", HARD / "scene.toml", "--with", "tracer", "--format", format, "-o", "maps")
    assert check(HARD, tmp_path / "maps").passes
    assert "beam-0/visible.V" in raypencil.read(tmp_path / "maps")


def test_a_pack_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError, match="nowhere"):
        check(tmp_path / "nowhere", {"t": np.zeros(1)})
    with pytest.raises(RaypencilError, match="manifest.json"):
        check(tmp_path, {"t": np.zeros(1)})
