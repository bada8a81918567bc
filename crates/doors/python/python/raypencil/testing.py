"""For tests of ray tracers: hard rays, and assertions that leave a report. The fixtures of pytest are made of these."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._judge import KNOWN, Arithmetic, Judgement, answers_of, judge
from ._mesh import Mesh, load_mesh
from ._packs import CheckResult, check, pack_rays

__all__ = ["HardRays", "assert_answers", "hard_rays", "packs_in"]

_HARD = Path(__file__).parent / "data" / "hard_rays"


@dataclass(frozen=True)
class HardRays:
    """Rays at which ray tracers go wrong, on a mesh of their own. ``raypencil.judge(hard.mesh, hard.rays, answers)``."""

    name: str
    #: What the rays are, and what goes wrong with them.
    what: str
    goes_wrong: str
    folder: Path

    @cached_property
    def mesh(self) -> Mesh:
        """The mesh."""
        return load_mesh(self.folder / "mesh.obj")

    @cached_property
    def rays(self) -> NDArray[np.float64]:
        """(n, 8) float64: origin, direction, t_min, t_max."""
        rays = np.load(self.folder / "rays.npy").astype(np.float64)
        if rays.shape[-1] == 6:
            ends = np.broadcast_to([0.0, np.inf], (*rays.shape[:-1], 2))
            rays = np.concatenate([rays, ends], axis=-1)
        rays.flags.writeable = False
        return np.asarray(rays)

    @property
    def origins(self) -> NDArray[np.float64]:
        """(n, 3)."""
        return self.rays[..., 0:3]

    @property
    def directions(self) -> NDArray[np.float64]:
        """(n, 3): not unit vectors."""
        return self.rays[..., 3:6]

    @property
    def t_min(self) -> NDArray[np.float64]:
        """(n,): hits before it do not count."""
        return self.rays[..., 6]

    @property
    def t_max(self) -> NDArray[np.float64]:
        """(n,): nor hits after it. Infinite: the ray has no end."""
        return self.rays[..., 7]

    @cached_property
    def answers(self) -> Mapping[str, NDArray[Any]]:
        """The exact answers, as of :class:`raypencil.CastResult`."""
        return {file.stem: np.load(file) for file in sorted((self.folder / "answers").glob("*.npy"))}

    def __str__(self) -> str:
        return self.name


def hard_rays() -> dict[str, HardRays]:
    """The families of hard rays that come with this package, by name: docs/hard-rays.md describes them."""
    families = json.loads((_HARD / "families.json").read_text(encoding="utf-8"))
    return {
        one["name"]: HardRays(one["name"], one["what"], one["goesWrong"], _HARD / one["name"]) for one in families
    }


def packs_in(folder: str | os.PathLike[str]) -> dict[str, Path]:
    """The reference packs in a folder, or the folder itself if it is one, by name.

    Args:
        folder: may be missing; then there are none.
    """
    marks = ("manifest.json", "raypack.json")
    root = Path(folder)
    places = [root, *sorted(path for path in root.iterdir() if path.is_dir())] if root.is_dir() else []
    return {place.resolve().name: place for place in places if any((place / mark).is_file() for mark in marks)}


def assert_answers(
    pack: str | os.PathLike[str] | HardRays,
    answers: Any,
    arithmetic: Arithmetic | None = None,
    *,
    reports: str | os.PathLike[str],
    miss: float | None = None,
    no_faces: bool = False,
    name: str = "answers",
) -> CheckResult | Judgement:
    """Asserts that answers to a pack, or to hard rays, are right.

    Args:
        pack: the folder of a pack, or hard rays.
        answers: as :func:`raypencil.check` takes them.
        arithmetic: that of the answers.
        reports: folder for the report of a failure.
        miss, no_faces, name: as :func:`raypencil.check`.

    Raises:
        AssertionError: some are wrong: which, the mistake that explains them, and the folder with ``report.html``.
    """
    folder = Path(reports)
    if isinstance(pack, HardRays):
        arrays = dict(answers_of(answers))
        if no_faces:
            arrays.pop("face", None)
        if not isinstance(answers, Mapping):
            arrays = {key: array for key, array in arrays.items() if key in KNOWN}
        judged = judge(pack.mesh, pack.rays, arrays, arithmetic or "f64", miss=miss, name=name, explain=False)
        if judged.passes:
            return judged
        # The same once more, as a pack: that leaves a report.
        pack_rays(pack.mesh, pack.rays, folder / "pack", force=True)
        arrays.pop("hit", None)
        checked = check(
            folder / "pack", arrays, arithmetic, miss=miss, no_faces=no_faces, name=name, output=folder, force=True
        )
        text = checked.text if not checked.passes else judged.text
        raise AssertionError(f"{pack.name}: {pack.what}\n\n{text}\nreport: {folder / 'report.html'}")
    # A report takes the place of another one.
    checked = check(
        pack, answers, arithmetic, miss=miss, no_faces=no_faces, name=name, output=folder, force=True
    )
    if checked.passes:
        return checked
    raise AssertionError(f"{pack}\n\n{checked.text}\nreport: {folder / 'report.html'}")
