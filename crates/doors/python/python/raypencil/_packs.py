"""Reference packs: questions with their exact answers, and the check of somebody's answers."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from . import _arrays, _raypencil
from ._errors import RaypencilError
from ._judge import Arithmetic, answers_of
from ._mesh import as_mesh
from ._progress import Progress, stages
from ._renamed import Renamed, renamed
from ._scene import as_scene
from ._validate import Outcome

PathLike = str | os.PathLike[str]


@renamed(Renamed("version", "pack_version"), Renamed("bench", "no_bench", is_opposite=True))
def pack(
    scene: Any,
    output: PathLike,
    *,
    no_bench: bool = False,
    pack_version: str | None = None,
    licence: str | None = None,
    force: bool = False,
    progress: Progress = False,
) -> Path:
    """Writes the reference pack of a scene: its rays, and the answer to each, correctly rounded.

    Args:
        scene: a :class:`Scene`, or a name or path of one.
        output: the folder.
        no_bench: leave the scene as it is. Without it small sensors are added whose rays lie at the limits of the contract.
        pack_version: of the pack itself, such as ``"1.0.0"``: for packs that are passed on.
        licence: of the pack itself, an SPDX expression such as ``"CC0-1.0"``.
        force: replace another pack or other results that ``output`` has; without it they are an error.
        progress: see :func:`cast`.

    Returns:
        The folder.

    Raises:
        RaypencilError: a version or a licence that is none.
    """
    with stages(progress) as on_stage:
        _raypencil.pack_scene(as_scene(scene)._core, os.fspath(output), not no_bench, pack_version, licence, force, on_stage)
    return Path(output)


def pack_rays(
    mesh: Any,
    rays: Any,
    output: PathLike,
    *,
    fronts_only: bool = False,
    force: bool = False,
    progress: Progress = False,
) -> list[str]:
    """Writes a pack of rays on a mesh: the question, and the exact answers with their margins.

    Args:
        mesh: as in :func:`cast`.
        rays: as in :func:`judge`; or the path of a file of patterns, TOML with tables ``[[rays]]``. Each of its sets becomes a pack
            of a scan, with times and poses, to which :func:`check` holds point clouds; several sets have a folder each in
            ``output``, by their names.
        output: the folder.
        fronts_only: rays pass through the backs of faces.
        force: as for :func:`pack`.
        progress: see :func:`cast`.

    Returns:
        What none of the rays tests, in words: ``ties``, ``backs of faces``, ``t_min``, ...
    """
    if isinstance(rays, (str, os.PathLike)):
        with stages(progress) as on_stage:
            return _raypencil.pack_ray_sets(
                as_mesh(mesh)._core, os.fspath(rays), os.fspath(output), fronts_only, force, on_stage
            )
    of_rays, shape = _arrays.given_rays(rays)
    with stages(progress) as on_stage:
        return _raypencil.pack_rays(
            as_mesh(mesh)._core, of_rays, list(shape), os.fspath(output), fronts_only, force, on_stage
        )


class CheckResult(Outcome):
    """Somebody's answers against a pack.

    Attributes:
        kind: ``"sensors"``, ``"rays"`` or ``"triangles"``.
        why: the mistake that explains the wrong rays, in words; ``None`` if none does, or if nothing is wrong.
        classes: of a pack of rays, uint8 of the rays' shape: 0 the same, 1 at a tie, 2 rounding, 3 wrong; else ``None``.
        moved: of a pack of rays, (..., 2): as :attr:`Judgement.moved`; else ``None``.
        output: the folder with ``report.html``, if one was asked for.
    """

    def __init__(self, answer: Mapping[str, Any], output: Path | None) -> None:
        super().__init__(answer["passes"], answer["text"], answer["json"])
        self.kind: str = answer["kind"]
        self.why: str | None = answer["why"]
        self.output = output
        self.classes: NDArray[np.uint8] | None = None
        self.moved: NDArray[np.float64] | None = None
        if "verdict" in answer["arrays"]:
            shape = tuple(answer["shape"])
            self.classes = _arrays.frozen(answer["arrays"]["verdict"].reshape(shape))
            self.moved = _arrays.frozen(answer["arrays"]["moved"].reshape((*shape, 2)))

    def __repr__(self) -> str:
        return f"<raypencil.CheckResult: {'passes' if self.passes else 'wrong'}, a pack of {self.kind}>"


def _flat(answers: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    """Arrays by their keys; of nested dictionaries joined by ``/``."""
    for key, value in answers.items():
        if isinstance(value, Mapping):
            yield from _flat(value, f"{prefix}{key}/")
        else:
            yield f"{prefix}{key}", value


def _write(answers: Mapping[str, Any], folder: Path) -> None:
    """A recording of the arrays."""
    for key, value in _flat(answers):
        if key.startswith("/") or ".." in key.split("/") or "\\" in key:
            raise RaypencilError(f"answers: {key!r} is no name of an array; expected one such as camera/range.T")
        path = folder / f"{key}.npy"
        path.parent.mkdir(parents=True, exist_ok=True)
        array = np.asarray(value)
        if array.dtype.kind not in "fiub":
            raise RaypencilError(f"answers: {key} is of type {array.dtype}; expected real numbers")
        np.save(path, array)


def check(
    pack: PathLike,
    answers: Any,
    arithmetic: Arithmetic | None = None,
    *,
    miss: float | None = None,
    no_faces: bool = False,
    frame: Literal["mesh", "sensor", "start", "end"] | None = None,
    topic: str | None = None,
    message: int | None = None,
    channels: Mapping[str, str] | None = None,
    scale: float | None = None,
    verify: bool = False,
    name: str = "answers",
    output: PathLike | None = None,
    force: bool = False,
    progress: Progress = False,
) -> CheckResult:
    """Checks somebody's answers against a reference pack of any kind.

    Args:
        pack: folder of the pack.
        answers: a folder of EXR, NPY, NPZ, PFM, PNG or TIFF files or a Zarr store, or arrays. For a pack of rays: a dictionary with ``face``, ``t``, ..., a
            :class:`CastResult`, or the path of a point cloud (.pcd, .ply, or a bag that has it, .mcap). For a pack of a scene: a dictionary with the channels of docs/formats/files.md, as
            ``"camera/range.T"`` or nested, or a :class:`RenderResult`. For an input pack: ``triangles`` (m, 9) and
            ``reflectivity`` (m,).
        arithmetic: that of the answers, whatever type they are stored in. Default: as the folder's ``candidate.json`` says,
            else ``"f64"``.
        miss: a number that means no hit; of whole numbers with ``scale``, as the file has it.
        no_faces: leave out the indices of faces.
        frame: of the points of a cloud: that of the mesh (the default), of the sensor when it fires each ray, or of the sensor at
            the start or the end of its scan: when it fires the first or the last ray.
        topic: of a bag, that of the cloud. Default: the only one with clouds.
        message: which of the topic's clouds, from 1. Default: the only one.
        channels: which channel of the files is which map, such as ``{"depth.Z": "ViewLayer.Depth.Z"}``. The map says what the
            numbers are: ``depth.Z`` along the optical axis, ``range.T`` along the ray. docs/formats/files.md has the rules; a
            ``candidate.json`` can declare the same.
        scale: metres for each unit of ``range.T``, ``depth.Z`` and ``view.Z`` in whole numbers, such as 0.001 for depth images
            of 16 bits in millimetres. 0 then means no hit.
        verify: of a pack of a scene, compare every answer of the pack with the referee's; without it a sample, and each
            by which a ray is wrong. The text says how many were.
        name: what messages call answers that are no folder.
        output: a folder for ``report.html``, ``junit.xml``, ``summary.md`` and ``check.json``.
        force: replace what ``output`` has of another command, or of something else; without it that is an error.
        progress: see :func:`cast`.

    Raises:
        RaypencilError: a pack that is not complete and unchanged, answers that break the conventions.
    """
    folder = None if output is None else Path(output)

    def checked(candidate: Path) -> CheckResult:
        with stages(progress) as on_stage:
            answer = _raypencil.check(
                os.fspath(pack), os.fspath(candidate), list((channels or {}).items()), scale, arithmetic, miss, no_faces,
                frame, topic, message, verify, folder and os.fspath(folder), force, on_stage,
            )
        return CheckResult(answer, folder)

    if isinstance(answers, (str, os.PathLike)):
        return checked(Path(answers))
    if not name or "/" in name or name.startswith("."):
        raise RaypencilError(f"name is {name!r}; expected one that a folder can have")
    with tempfile.TemporaryDirectory(prefix="raypencil-") as temporary:
        candidate = Path(temporary, name)
        candidate.mkdir()
        _write(answers_of(answers), candidate)
        return checked(candidate)


def read(
    path: PathLike,
    *,
    channels: Mapping[str, str] | None = None,
    scale: float | None = None,
    progress: Progress = False,
) -> dict[str, NDArray[Any]]:
    """Reads the maps of a file or folder of any program: EXR, NPY, NPZ, Zarr, PFM, PNG, TIFF.

    Args:
        path: of the file, folder or store.
        channels, scale: as for :func:`check`.
        progress: see :func:`cast`.

    Returns:
        Channels by their keys (docs/formats/files.md), such as ``camera/range.T``: (rows, columns), row 0 on top; float32 or
        float64 as the file has them, uint32 for whole numbers.

    Raises:
        RaypencilError: what is wrong with which file.
    """
    with stages(progress) as on_stage:
        return dict(_arrays.frozen(_raypencil.read_recording(os.fspath(path), list((channels or {}).items()), scale, on_stage)))


