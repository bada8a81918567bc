"""Maps: the numbers of the command's files, in the shapes and units that are promised."""

from __future__ import annotations

import pickle
from pathlib import Path

import numpy as np
import pytest
from conftest import SMALL, Command, same_bits

import raypencil
from raypencil import RaypencilError, Scene, render


def assert_are_files(result: raypencil.RenderResult, folder: Path) -> None:
    """The channels of the files are the arrays, rounded to the type of the file."""
    files = raypencil.read(folder)
    channels: dict[str, np.ndarray] = {}
    for key, array in result.arrays.items():
        parts = [(f"{key}.{axis}", array[..., at]) for at, axis in enumerate("XYZ")] if array.ndim == 3 else [(key, array)]
        channels.update(parts)
    assert sorted(files) == sorted(channels)
    for key, file in files.items():
        rounded = channels[key].astype(file.dtype)
        # NaN of files has one pattern of bits.
        if file.dtype.kind == "f":
            assert np.array_equal(rounded, file, equal_nan=True), key
        else:
            assert same_bits(np.ascontiguousarray(rounded), file), key


@pytest.mark.parametrize("renderer", ["scanline", "tracer", "referee", "scanline-paper"])
def test_maps_are_those_of_the_command(small: Scene, command: Command, tmp_path: Path, renderer: str) -> None:
    (tmp_path / "small.toml").write_text(SMALL)
    command("render", "small.toml", "--with", renderer, "-o", "theirs")
    result = render(small, renderer, output=tmp_path / "ours")
    assert_are_files(result, tmp_path / "theirs")
    for file in (tmp_path / "theirs").glob("*.exr"):
        assert file.read_bytes() == (tmp_path / "ours" / file.name).read_bytes()


def test_shapes_and_types(small: Scene) -> None:
    result = render(small)
    assert list(result) == ["camera", "beam-0", "beam-1"] and len(result.beams) == 2
    shapes = {name: (array.shape, array.dtype.str) for name, array in result["beam-0"].items()}
    assert shapes == {
        "range": ((4, 64), "<f8"),
        "depth": ((4, 64), "<f8"),
        "point": ((4, 64, 3), "<f8"),
        "normal": ((4, 64, 3), "<f8"),
        "face": ((4, 64), "<u4"),
        "cos_incidence": ((4, 64), "<f8"),
        "visible": ((4, 64), "|b1"),
        "pixel": ((4, 64, 2), "<u4"),
        "view_depth": ((4, 64), "<f8"),
        "cos_off_axis": ((4, 64), "<f8"),
        "cos_view": ((4, 64), "<f8"),
        "flux": ((4, 64), "<f8"),
    }
    camera = result.camera
    assert camera["range"].shape == (36, 48) and camera["flux"].shape == (2, 36, 48)
    assert not camera["range"].flags.writeable and not result["beam-1"]["pixel"].flags.writeable


def test_numbers_by_hand(small: Scene) -> None:
    camera = render(small, "tracer").camera
    hit = camera["face"] != 4294967295
    assert np.array_equal(np.isfinite(camera["range"]), hit) and np.array_equal(~np.isnan(camera["point"][..., 0]), hit)
    # Row 0 is the top one: it looks farther than the last.
    assert camera["range"][-1].max() < camera["range"][hit.all(axis=1).argmax()].min()
    # Depth is along the axis, range along the ray: point = position + range x direction.
    position, axis = small.camera.scene_from_sensor.position, small.camera.scene_from_sensor.matrix[:3, 2]
    along = camera["point"][hit] - position
    assert np.allclose(np.linalg.norm(along, axis=1), camera["range"][hit], rtol=1e-12)
    assert np.allclose(along @ axis, camera["depth"][hit], rtol=1e-12)
    # Columns go to the right, which is -y of a vehicle that looks along x.
    points = camera["point"][-1]
    assert (np.diff(points[:, 1]) < 0).all()


def test_light_that_arrives_is_light_that_was_sent_back(small: Scene) -> None:
    result = render(small)
    for beam, maps in enumerate(result.beams):
        assert np.isclose(maps["flux"].sum(), result.camera["flux"][beam].sum(), rtol=1e-12)
        lit = maps["flux"] > 0
        assert lit.any() and not (lit & ~maps["visible"]).any()
        # The pixel is (column, row).
        column, row = maps["pixel"][lit].T
        assert (column < 48).all() and (row < 36).all() and (result.camera["flux"][beam][row, column] > 0).all()


def test_switches_and_random_rays(small: Scene, tmp_path: Path, command: Command) -> None:
    (tmp_path / "small.toml").write_text(SMALL)
    command("render", "small.toml", "--with", "tracer", "--jitter", 7, "-o", "theirs")
    assert_are_files(render(small, "tracer", jitter=7), tmp_path / "theirs")
    command("render", "small.toml", "--with", "scanline", "--switch", "beam-edges=paper", "-o", "switched")
    assert_are_files(render(small, switches={"beam-edges": "paper"}), tmp_path / "switched")


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"with_": "mitsuba"}, 'no renderer "mitsuba"; expected one of scanline, scanline-paper, tracer, referee'),
        ({"jitter": 1}, "jitter=1: scanline cannot trace random rays"),
        ({"with_": "tracer", "switches": {"facing": "paper"}}, "tracer has no switches"),
        ({"switches": {"facings": "paper"}}, "switch facings=paper"),
        ({"switches": {"facing": "real"}}, 'switch facing is "real"'),
    ],
)
def test_what_is_wrong_is_named(small: Scene, options: dict[str, object], words: str) -> None:
    with pytest.raises(RaypencilError, match=words):
        render(small, **options)  # type: ignore[arg-type]


def test_a_folder_that_cannot_be_written_is_an_error_of_files(small: Scene, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(OSError, match="file") as caught:
        render(small, output=tmp_path / "file" / "below")
    assert isinstance(caught.value, RaypencilError)


def test_xarray_has_coordinates_and_units(small: Scene) -> None:
    pytest.importorskip("xarray")
    result = render(small)
    camera, beam = result.to_xarray(), result.to_xarray("beam-1")
    assert dict(camera.sizes) == {"row": 36, "column": 48, "xyz": 3, "beam": 2}
    assert camera.flux.dims == ("beam", "row", "column") and camera.flux.attrs["units"] == "W"
    assert camera.attrs["scene_sha256"] == small.sha256 and camera.range.attrs["units"] == "m"
    assert beam.pixel.sel(ij="j").shape == (2, 48) and beam.row.values.tolist() == [0, 1]
    with pytest.raises(RaypencilError, match="sensor is 'beam-2'; expected one of camera, beam-0, beam-1"):
        result.to_xarray("beam-2")


def test_results_can_be_pickled_and_shown(small: Scene) -> None:
    result = render(small)
    again = pickle.loads(pickle.dumps(result))
    assert same_bits(again.camera["point"], result.camera["point"]) and not again.camera["point"].flags.writeable
    assert result._repr_html_().count("data:image/png;base64,iVBOR") == 3 and "48 x 36" in repr(result)
    # The flux of both beams in one picture.
    assert result.picture(name="flux").startswith(b"\x89PNG")
    both = result.camera["flux"]
    shown = [
        type(result)({"camera": {"flux": np.array(flux)}}, "x", "", "W").picture(name="flux")
        for flux in (both, both.sum(axis=0), both[0], both[1])
    ]
    assert shown[0] == shown[1] and shown[0] not in shown[2:]
    with pytest.raises(RaypencilError, match="point has 3 numbers"):
        result.picture(name="point")
