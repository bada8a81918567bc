"""What the tests have in common: the data of the repository, and the command."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

import raypencil

ROOT = Path(__file__).parents[4]
DATA = ROOT / "data"

#: A small camera and two small beams on the pyramids.
SMALL = """version = 1
[terrain]
builtin = "pyramids"
[camera]
width_px = 48
height_px = 36
pixel_pitch_um = 190
[[beam]]
columns = 64
rows = 4
[[beam]]
columns = 48
rows = 2
"""

Command = Callable[..., subprocess.CompletedProcess[str]]


@pytest.fixture
def command(tmp_path: Path) -> Command:
    """Runs the command of the wheel in a folder of its own."""

    def run(*words: object, code: int = 0) -> subprocess.CompletedProcess[str]:
        arguments = [sys.executable, "-m", "raypencil", *map(str, words)]
        done = subprocess.run(arguments, cwd=tmp_path, capture_output=True, text=True, timeout=300)
        assert done.returncode == code, done.stdout + done.stderr
        return done

    return run


@pytest.fixture
def fake_program(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[[str], None]:
    """Puts a program of a few words of the shell in the place of the one that asks ray tracers of Rust."""
    if sys.platform == "win32":
        pytest.skip("it is a program of the shell")

    def put(words: str) -> None:
        file = tmp_path / f"program{len(list(tmp_path.iterdir()))}"
        file.write_text(f"#!/bin/sh\n{words}\n", encoding="utf-8")
        file.chmod(0o755)
        monkeypatch.setenv("RAYPENCIL_PEERS_RUST", str(file))

    return put


@pytest.fixture(scope="session")
def cube() -> raypencil.Mesh:
    """The cube from -1 to 1, 12 faces."""
    return raypencil.load_mesh(DATA / "rays" / "cube.obj")


@pytest.fixture(scope="session")
def small() -> raypencil.Scene:
    """The small scene."""
    return raypencil.Scene(SMALL, name="small")


def same_bits(a: NDArray[np.generic], b: NDArray[np.generic]) -> bool:
    """Whether two arrays have one type, one shape and the same bits: also the NaN and the signs of zeros."""
    return a.dtype == b.dtype and a.shape == b.shape and a.tobytes() == b.tobytes()


def random_rays(count: int, seed: int = 1) -> NDArray[np.float64]:
    """Rays (count, 8) around and into the cube, with ends of all kinds."""
    draw = np.random.default_rng(seed)
    rays = np.empty((count, 8))
    rays[:, 0:3] = draw.uniform(-3, 3, (count, 3))
    rays[:, 3:6] = draw.uniform(-1, 1, (count, 3)) - 0.4 * rays[:, 0:3]
    rays[:, 6] = np.where(draw.random(count) < 0.5, 0.0, draw.uniform(0, 2, count))
    rays[:, 7] = np.where(draw.random(count) < 0.5, np.inf, rays[:, 6] + draw.uniform(0, 4, count))
    return rays
