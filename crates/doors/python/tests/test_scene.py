"""Scenes: every way to make one, every way to be wrong, and the numbers in their units."""

from __future__ import annotations

import math
import pickle
from pathlib import Path

import numpy as np
import pytest
from conftest import DATA, SMALL, Command, same_bits

import raypencil
from raypencil import RaypencilError, Scene


def test_a_name_a_path_a_text_and_tables_are_scenes(tmp_path: Path) -> None:
    (tmp_path / "small.toml").write_text(SMALL)
    by_tables = Scene(
        terrain={"builtin": "pyramids"},
        camera={"width_px": 48, "height_px": 36, "pixel_pitch_um": 190},
        beam=[{"columns": 64, "rows": 4}, {"columns": np.int64(48), "rows": 2}],
    )
    same = [Scene(SMALL), Scene(str(tmp_path / "small.toml")), Scene(tmp_path / "small.toml"), by_tables]
    assert len({scene.sha256 for scene in same}) == 1
    assert Scene("pyramids").sha256 == Scene().sha256 == Scene("version = 1\n").sha256
    assert Scene("pyramids").sha256 != Scene("facets").sha256
    assert (Scene(tmp_path / "small.toml").name, Scene(SMALL, name="mine").name) == ("small", "mine")


def test_settings_are_in_the_units_of_the_file() -> None:
    scene = Scene("pyramids").replace(**{"camera.focal_length_mm": 6, "beam.1.thickness_mm": 4, "vehicle.heading_deg": 90})
    assert scene.camera.focal_length == 0.006
    assert [beam.thickness for beam in scene.beams] == [0.005, 0.004]
    assert scene.vehicle is not None
    # A quarter of a turn to the left: x becomes y.
    assert np.allclose(scene.vehicle.matrix[:3, 0], [0, 1, 0])
    # 20 degrees down: the camera's axis, its z, leads (cos 20, 0, -sin 20) from a vehicle that looks along x.
    down = math.radians(25)
    camera = Scene("pyramids", camera={"pitch_down_deg": 25}).camera
    assert np.allclose(camera.scene_from_sensor.matrix[:3, 2], [math.cos(down), 0, -math.sin(down)])
    assert np.allclose(camera.scene_from_sensor.position, [0.3, 0, 1.5])


def test_a_camera_by_pixels_angles_or_a_calibration(tmp_path: Path) -> None:
    # fx = 889 pixels of 9 um; the middle of pixel (0, 0) is at (0, 0), so that cx = 511.5 is the middle of 1024 columns.
    by_pixels = Scene("pyramids", camera={"intrinsics_px": {"fx": 889, "cx": 511.5, "cy": 511.5}})
    assert by_pixels.camera.focal_length == 889 * 9e-6
    across = 2 * math.degrees(math.atan(512 / 889))
    by_angle = Scene("pyramids").replace(**{"camera.field_of_view_deg": across})
    assert math.isclose(by_angle.camera.focal_length, 889 * 9e-6, rel_tol=1e-14)
    matrix = "[889, 0, 511.5, 0, 889, 511.5, 0, 0, 1]"
    (tmp_path / "left.yaml").write_text(f"image_width: 1024\nimage_height: 1024\ncamera_matrix: {{data: {matrix}}}\n")
    (tmp_path / "rig.toml").write_text('version = 1\n[camera]\ncamera_info = "left.yaml"\n')
    # The digest is of the numbers of the scene, and these are the same.
    assert Scene(tmp_path / "rig.toml").sha256 == by_pixels.sha256


def test_replace_makes_another_scene_each_time() -> None:
    scene = Scene(SMALL)
    once = scene.replace(**{"beam.rows": 3})
    twice = once.replace(beam={"columns": 32}, camera={"width_px": 24})
    assert [beam.rows for beam in scene.beams] == [4, 2] and scene.settings == {}
    assert [(beam.rows, beam.columns) for beam in twice.beams] == [(3, 32), (3, 32)] and twice.camera.width == 24
    assert twice.settings == {"beam.rows": "3", "beam.columns": "32", "camera.width_px": "24"}
    assert once.replace(**{"beam.0.rows": 7}).beams[0].rows == 7
    assert "--set beam.rows=3" in repr(once)
    assert Scene("pyramids", settings={"terrain.builtin": "facets"}).sha256 == Scene("facets").sha256


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: Scene("version = 1\n[camera]\nfocal_length_mm = -6\n", name="short"),
         r"short.toml:3:19: `camera.focal_length_mm` is -6; expected 0.01 to 100000 millimetres"),
        (lambda: Scene(camera={"focal_lenght_mm": 6}), "^keyword camera: .*focal_lenght_mm"),
        (lambda: Scene(vehicle={"heading_deg": 3}, camera={"pitch_down_deg": 400}),
         r"^keyword camera: `camera.pitch_down_deg` is 400; expected -360 to 360 degrees"),
        (lambda: Scene(terain={"builtin": "facets"}), r"^keyword terain: "),
        (lambda: Scene(camera={"pitch_down_deg": math.nan}), "camera.pitch_down_deg"),
        (lambda: Scene(camera={"pitch_down_deg": object()}), "`camera.pitch_down_deg` is of type object"),
        (lambda: Scene(camera={"pitch down": 3}), "'pitch down' is no key"),
        (lambda: Scene("pyramids").replace(**{"camera.pitch_down_deg": 400}),
         r"set camera.pitch_down_deg=400: .*expected -360 to 360 degrees"),
        (lambda: Scene("pyramids").replace(**{"beam.7.rows": 4}), r"beam.7"),
        (lambda: Scene("pyramids").replace(**{"beam.0.rows": 4, "beam.rows": 5}),
         r"set beam.rows=5: beam.0.rows=4 sets the same; expected one of the two"),
        (lambda: Scene("pyramids", settings={"camera.field_of_view_deg": 60, "camera.focal_length_mm": 8}),
         r"set camera.focal_length_mm=8: it cannot stand beside camera.field_of_view_deg=60"),
        (lambda: Scene("pyramids").replace(**{"camera.": 4}), r"is no key"),
        (lambda: Scene("ground.xyz"), r"`ground.xyz` is neither a built-in name nor a file"),
        (lambda: Scene(SMALL, name="../up"), r"name is '../up'"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_named(make: object, words: str) -> None:
    with pytest.raises(RaypencilError, match=words):
        make()  # type: ignore[operator]


def test_texts_survive_as_toml() -> None:
    from raypencil import _toml

    for text in ['a"b', "c\\d", "line\nbreak", "tab\t", "ü", "\x7f", "2", "true"]:
        document = _toml.document({"x": text})
        tomllib = pytest.importorskip("tomllib")
        assert tomllib.loads(document)["x"] == text
    for value in [True, False, np.True_, 3, -0.1, 1e-300, 5e22, [1, [2.5]], {"a": {"b": "c"}}, np.float32(0.5), np.arange(3)]:
        tomllib = pytest.importorskip("tomllib")
        read = tomllib.loads(_toml.document({"x": value}))["x"]
        assert np.array_equal(read, value) if isinstance(value, np.ndarray) else read == value
        # 1 is equal to True, and no truth value for a scene.
        assert isinstance(read, bool) == isinstance(value, (bool, np.bool_))


def test_pickles_are_the_same_scene(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "mine.toml").write_text(SMALL)
    monkeypatch.chdir(tmp_path)
    scenes = [Scene(SMALL, name="mine"), Scene("mine.toml").replace(**{"beam.rows": 3}), Scene("facets")]
    pickles = [pickle.dumps(scene) for scene in scenes]
    # A worker may be elsewhere.
    monkeypatch.chdir("/")
    for scene, text in zip(scenes, pickles, strict=True):
        again = pickle.loads(text)
        assert again.sha256 == scene.sha256 and again.name == scene.name and again.settings == scene.settings
    (tmp_path / "mine.toml").write_text(SMALL.replace("48", "40"))
    with pytest.raises(RaypencilError, match="another one than that which was pickled"):
        pickle.loads(pickles[1])


def test_the_text_of_a_scene_is_the_scene(tmp_path: Path) -> None:
    (tmp_path / "mine.toml").write_text(SMALL)
    for scene in [Scene(SMALL), Scene(tmp_path / "mine.toml"), Scene("facets"), Scene(camera={"width_px": 100})]:
        assert Scene(scene.toml).sha256 == scene.sha256


def test_the_terrain_is_an_array() -> None:
    scene = Scene(DATA / "scenes/ramp.toml")
    mesh = scene.mesh
    assert mesh is scene.mesh and scene.reflectivity.shape == (len(mesh.faces),)
    # A plane that rises by 1 m in 4.
    assert np.allclose(mesh.vertices[:, 2], mesh.vertices[:, 0] / 4) and (scene.origin == 0).all()
    assert scene.flux_unit == "W" and scene.beams[0].rows == 4


def test_sets_of_rays_are_arrays_and_answered_as_by_the_command(command: Command, tmp_path: Path) -> None:
    text = SMALL + '[[rays]]\nname = "mast"\nspinning = { preset = "vlp-16" }\nposition_m = [0, 0, 1.2]\nsides = "fronts"\n'
    (tmp_path / "lidar.toml").write_text(text)
    command("cast", "lidar.toml", "-o", "out")
    scene = Scene(text)
    assert Scene(SMALL).ray_sets == {} and list(scene.ray_sets) == ["mast"]
    mast = scene.ray_sets["mast"]
    assert mast.rays.shape[1:] == (16, 8) and mast.fronts_only
    assert mast.times is not None and same_bits(mast.times, np.load(tmp_path / "out/time.npy"))
    answers = raypencil.cast(scene, mast.rays, fronts_only=mast.fronts_only)
    for name in ("face", "t", "point"):
        assert same_bits(answers.arrays[name], np.load(tmp_path / f"out/{name}.npy")), name
    # A sensor with a shortest range has a number more, and what is too near for it is told.
    text = text.replace('"vlp-16" }', '"vlp-16", min_range_m = 5 }')
    (tmp_path / "lidar.toml").write_text(text)
    command("cast", "lidar.toml", "-o", "blind")
    mast = Scene(text).ray_sets["mast"]
    assert mast.rays.shape[1:] == (16, 9) and (mast.rays[..., 8] == 5).all() and (mast.rays[..., 6] == 0).all()
    blind = raypencil.cast(Scene(text), mast.rays, fronts_only=mast.fronts_only)
    assert same_bits(blind.t, np.load(tmp_path / "blind/t.npy")) and blind.too_near.any()
    assert np.array_equal(blind.too_near, answers.hit & (answers.t < 5))


def test_returns_of_beams_are_those_of_the_files(command: Command, tmp_path: Path) -> None:
    grid = "{ grid = { columns = 12, rows = 6, width_deg = 90, height_deg = 50 } }"
    # Air so thick that it decides which return is the strongest.
    rules: list[tuple[str | int, float]] = [("first", 0.0), ("strongest", 0.0), ("strongest", 0.75), ("last", 0.0), (2, 0.0)]
    for keep, extinction in rules:
        asked = f"{{ keep = {keep!r}, separation_m = 0.25 }}"
        text = SMALL + (
            f'[[rays]]\nname = "wide"\ncone = {{ of = {grid}, divergence_mrad = 60, rings = 2, returns = {asked} }}\n'
            f"position_m = [0, 0, 1.2]\npitch_down_deg = 30\nreflectivity = 0.5\nextinction_per_m = {extinction}\n"
        ).replace("'", '"')
        (tmp_path / "wide.toml").write_text(text)
        folder = f"of_{keep}_{extinction}"
        command("cast", "wide.toml", "-o", folder)
        scene = Scene(text)
        wide = scene.ray_sets["wide"]
        assert wide.returns == raypencil.Returns(keep, 0.25)
        assert (wide.reflectivity, wide.extinction_per_m) == (0.5, extinction)
        found = wide.beam_returns(raypencil.cast(scene, wide.rays))
        files = sorted((tmp_path / folder).rglob("return.*.npy"))
        assert sorted(found) == [file.name.split(".")[1] for file in files] and len(files) == 11
        for file in files:
            own, stored = found[file.name.split(".")[1]], np.load(file)
            # A file has a byte for each truth value.
            assert same_bits(own, stored.astype(own.dtype) if own.dtype == bool else stored), file.name
        assert (found["count"] >= 1).any()
    alone = Scene(SMALL + '[[rays]]\nname = "mast"\nspinning = { preset = "vlp-16", steps = 2 }\n').ray_sets["mast"]
    assert alone.returns is None
    with pytest.raises(RaypencilError, match="asks for no returns"):
        alone.beam_returns(raypencil.cast(scene, alone.rays))
    with pytest.raises(RaypencilError, match=r"answers to rays of shape \(2, 16\); expected those of the set"):
        wide.beam_returns(raypencil.cast(scene, alone.rays))


def test_generated_ground_is_the_same_by_table_and_by_call() -> None:
    scene = Scene(terrain={"generate": {"preset": "smooth", "seed": 3, "extent_m": 12}})
    mesh = raypencil.terrain.generate("smooth", 3, extent=12)
    assert mesh.vertices.tobytes() == (scene.mesh.vertices + scene.origin).tobytes()
    assert np.array_equal(mesh.faces, scene.mesh.faces)


def test_a_mesh_in_memory_is_a_ground(tmp_path: Path) -> None:
    x, y = np.meshgrid(np.linspace(-4, 4, 9), np.linspace(-4, 4, 9), indexing="ij")
    vertices = np.stack([x, y, 0.1 * np.sin(x)], axis=-1).reshape(-1, 3)
    corner = (np.arange(8)[:, None] * 9 + np.arange(8)).ravel()
    faces = np.concatenate([np.stack([corner, corner + 9, corner + 10], -1), np.stack([corner, corner + 10, corner + 1], -1)])
    mesh = raypencil.Mesh(vertices, faces)
    scene = Scene(mesh, camera={"pitch_down_deg": 25}, name="waves")
    assert scene.name == "waves" and len(scene.mesh.faces) == 128
    # In the scene frame, and rounded to single precision.
    assert np.abs(scene.mesh.vertices + scene.origin - vertices).max() < 1e-6
    # It is that of the file of this mesh.
    path = tmp_path / "waves.ply"
    path.write_bytes(Path(scene._source).read_bytes())
    theirs = Scene(path, camera={"pitch_down_deg": 25})
    assert (theirs.sha256, theirs.source_sha256) == (scene.sha256, scene.source_sha256)
    assert np.isfinite(raypencil.render(scene).camera["range"]).any()
    # As any mesh that `cast` takes, and as the ground of another scene.
    assert Scene((vertices, faces), name="waves").sha256 == Scene(terrain=mesh).sha256 == raypencil.Scene(mesh).sha256
    rig = "version = 1\nvehicle = { position_m = [1, 1] }\nterrain = { builtin = \"pyramids\" }\n"
    other = Scene(rig, terrain=mesh)
    assert len(other.mesh.faces) == 128 and other.vehicle is not None and other.vehicle.position[0] == 1
    # Copies and other settings have it too, also when the first scene is gone.
    turned, again = scene.replace({"camera.pitch_down_deg": 30}), pickle.loads(pickle.dumps(scene))
    moved, sha256 = pickle.loads(pickle.dumps(other)), scene.sha256
    del scene
    assert again.sha256 == sha256 != turned.sha256 and moved.sha256 == other.sha256
    assert len(turned.replace({"camera.pitch_down_deg": 20}).mesh.faces) == 128
    with pytest.raises(RaypencilError, match="two meshes"):
        Scene(mesh, terrain=mesh)
    with pytest.raises(RaypencilError, match="name is 'a/b'"):
        Scene(mesh, name="a/b")
    with pytest.raises(RaypencilError, match="no triangles"):
        Scene(raypencil.Mesh(vertices, np.zeros((0, 3), int)))
