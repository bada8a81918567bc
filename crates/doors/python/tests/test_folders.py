"""Output folders of functions: those of the commands, with the same rules."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import raypencil
from raypencil import RaypencilError, Scene

TEXT = """version = 1
beam = []
[vehicle]
position_m = [-0.6, 0]
[camera]
width_px = 8
height_px = 6
pixel_pitch_um = 1000
pitch_down_deg = 40
[terrain]
builtin = "pyramids"
[drive]
waypoints_m = [[0.2, 0]]
frames_per_s = 2
scans = false
"""

TRIANGLE = (np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]), np.array([[0, 1, 2]]))
RAYS = np.array([[0.2, 0.2, 1, 0, 0, -1, 0, 9]])


def driven(scene: Any, **of: Any) -> None:
    for _ in raypencil.drive(scene, with_="tracer", images=False, **of):
        pass


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    path = tmp_path / "small.toml"
    path.write_text(TEXT + "[[beam]]\ncolumns = 4\nrows = 1\n", encoding="utf-8")
    path.write_text(path.read_text().replace("beam = []\n", ""), encoding="utf-8")
    return path


@pytest.fixture
def calls(scene: Path, tmp_path: Path) -> dict[str, Callable[..., Any]]:
    """Each function that writes a folder, on the same scene."""
    pack = tmp_path / "a-pack"
    raypencil.pack(scene, pack, no_bench=True)
    return {
        "render": lambda **of: raypencil.render(scene, "tracer", **of),
        "validate": lambda **of: raypencil.validate(scene, **of),
        "drive": lambda **of: driven(scene, **of),
        "check": lambda **of: raypencil.check(pack, pack, **of),
        "diff": lambda **of: raypencil.diff(pack, pack, **of),
        "pack": lambda **of: raypencil.pack(scene, no_bench=True, **of),
        "pack_rays": lambda **of: raypencil.pack_rays(TRIANGLE, RAYS, **of),
        "sweep": lambda **of: raypencil.sweep(scene, do="render", **of),
        "campaign": lambda **of: raypencil.campaign(1, max_faces=1, **of),
    }


NAMES = ["render", "validate", "drive", "check", "diff", "pack", "pack_rays", "sweep", "campaign"]


@pytest.mark.parametrize("name", NAMES)
def test_results_of_something_else_are_not_replaced_unasked(
    name: str, calls: dict[str, Callable[..., Any]], tmp_path: Path
) -> None:
    out = tmp_path / "out"
    before = "validate" if name == "render" else "render"
    calls[before](output=out)
    kept = {path: path.read_bytes() for path in out.rglob("*") if path.is_file()}
    with pytest.raises(RaypencilError, match=f"`{before}` on .*small.toml; expected another folder, or force=True"):
        calls[name](output=out)
    assert {path: path.read_bytes() for path in out.rglob("*") if path.is_file()} == kept
    calls[name](output=out, force=True)
    # A folder that several runs share, or that is a pack, has no list.
    if name not in ("pack", "pack_rays", "sweep", "campaign"):
        assert "small.toml" in (out / ".raypencil-made").read_text() or "a-pack" in (out / ".raypencil-made").read_text()
    assert not (out / ".raypencil-lock").exists()


@pytest.mark.parametrize("name", NAMES)
def test_foreign_files_stay_and_ones_own_are_replaced(
    name: str, calls: dict[str, Callable[..., Any]], tmp_path: Path
) -> None:
    out = tmp_path / "out"
    calls[name](output=out)
    made = {path for path in out.rglob("*") if path.is_file()}
    assert made
    (out / "mine").mkdir()
    (out / "mine" / "x.npy").write_text("precious")
    calls[name](output=out)
    assert (out / "mine" / "x.npy").read_text() == "precious"
    assert {path for path in out.rglob("*") if path.is_file()} - made == {out / "mine" / "x.npy"}


def test_a_run_leaves_nothing_of_an_earlier_one(scene: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    raypencil.render(scene, "tracer", output=out)
    assert (out / "beam-0.exr").is_file()
    raypencil.render(scene, "tracer", output=out)
    scene.write_text(TEXT, encoding="utf-8")
    raypencil.render(scene, "tracer", output=out)
    assert (out / "camera.exr").is_file() and not (out / "beam-0.exr").exists()


def test_a_folder_in_which_another_run_works_is_refused(scene: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    drive = raypencil.drive(scene, with_="tracer", output=out)
    next(drive)
    with pytest.raises(RaypencilError, match="another run is writing into it"):
        raypencil.drive(scene, with_="tracer", output=out)
    drive.close()


def test_a_text_is_a_subject_by_its_name(tmp_path: Path) -> None:
    out = tmp_path / "out"
    raypencil.render(Scene(TEXT, name="a"), "tracer", output=out)
    raypencil.render(Scene(TEXT.replace("frames_per_s = 2", "frames_per_s = 3"), name="a"), "tracer", output=out)
    with pytest.raises(RaypencilError, match="`render` on the text a"):
        raypencil.render(Scene(TEXT, name="b"), "tracer", output=out)
