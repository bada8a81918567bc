"""Generated grounds are those of the command."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from conftest import Command

import raypencil
from raypencil import RaypencilError, Scene, terrain


@pytest.mark.parametrize(
    ("flags", "options"),
    [
        (["--preset", "smooth", "--seed", 7, "--extent", 12], {"preset": "smooth", "seed": 7, "extent": 12}),
        (
            ["--extent", 14, "--post-spacing", 0.5, "--rock-coverage", 0.1, "--rock-smallest", 0.4, "--crevasses", 1],
            {"extent": 14, "post_spacing": 0.5, "rock_coverage": 0.1, "rock_smallest": 0.4, "crevasses": 1},
        ),
        (["--extent", 12, "--fine-radius", 2], {"extent": 12, "fine_radius": 2}),
    ],
)
def test_a_ground_is_the_commands(command: Command, tmp_path: Path, flags: list[object], options: dict[str, object]) -> None:
    command("terrain", "generate", *flags, "-o", "ground.glb")
    mesh = terrain.generate(**options)  # type: ignore[arg-type]
    scene = Scene(tmp_path / "ground.glb")
    assert mesh.vertices.tobytes() == (scene.mesh.vertices + scene.origin).tobytes()
    assert np.array_equal(mesh.faces, scene.mesh.faces)
    assert mesh.bounds is not None
    low, high = mesh.bounds
    # Rocks and rims move the outermost posts a little.
    assert abs(high[0] - low[0] - float(str(options["extent"]))) < 0.5 and high[2] > low[2]


def test_presets_are_those_of_the_engine() -> None:
    with pytest.raises(RaypencilError, match=f"preset none: .*expected one of {', '.join(terrain.PRESETS)}"):
        terrain.generate("none")


def test_what_is_wrong_is_named() -> None:
    with pytest.raises(RaypencilError, match="extent"):
        terrain.generate(extent=-3)
    with pytest.raises(FileNotFoundError, match="nowhere.tif"):
        terrain.generate(coarse="nowhere.tif")
    with pytest.raises(OverflowError):
        terrain.generate(seed=-1)


def test_seeds_give_other_grounds() -> None:
    a, b, c = (terrain.generate("smooth", seed, extent=6) for seed in (1, 1, 2))
    assert a.vertices.tobytes() == b.vertices.tobytes() != c.vertices.tobytes()
    assert raypencil.cast(a, [0, 0, 50], [0, 0, -1]).hit
