"""Grounds: ``raypencil.terrain.generate``."""

from __future__ import annotations

import os

from . import _raypencil
from ._mesh import Mesh
from ._progress import Progress, stages

__all__ = ["PRESETS", "generate"]

#: The presets of :func:`generate`; docs/guide/terrain.md describes them.
PRESETS = ("smooth", "viking1", "pathfinder", "crater_field", "crevassed", "worst")


def generate(
    preset: str = "viking1",
    seed: int = 0,
    *,
    extent: float | None = None,
    post_spacing: float | None = None,
    fine_radius: float | None = None,
    rock_coverage: float | None = None,
    rock_smallest: float | None = None,
    crevasses: int | None = None,
    coarse: str | os.PathLike[str] | None = None,
    progress: Progress = False,
) -> Mesh:
    """A Mars-like ground, in the global frame: z up, metres. The same arguments give the same ground, bit for bit.

    Args:
        preset: one of :data:`PRESETS`.
        seed: of all random numbers, from 0.
        extent: side of the square, m.
        post_spacing: distance between neighbouring posts, m.
        fine_radius: within this distance of the middle posts stand at a quarter of the spacing, m.
        rock_coverage: share of the area that rocks cover, 0 to 0.4.
        rock_smallest: diameter of the smallest rocks, m.
        crevasses: their number.
        coarse: an elevation model (GeoTIFF) whose posts the surface interpolates; it gives the extent.
        progress: see :func:`raypencil.cast`.

    A scene on such a ground is ``Scene(terrain={"generate": {"preset": "viking1", "seed": 7}})``.

    Raises:
        RaypencilError: a preset that is not there, a value out of range.
    """
    path = None if coarse is None else os.fspath(coarse)
    with stages(progress) as on_stage:
        core = _raypencil.generate_ground(
            preset, seed, extent, post_spacing, fine_radius, rock_coverage, rock_smallest, crevasses, path, on_stage
        )
    return Mesh._of(core)
