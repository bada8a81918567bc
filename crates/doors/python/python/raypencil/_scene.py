"""Scenes: a ground, a camera, beams, a vehicle."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _raypencil, _toml
from ._cast_result import CastResult
from ._errors import RaypencilError
from ._mesh import BUILTIN_NAMES, Mesh, as_mesh
from ._progress import Progress, stages


@dataclass(frozen=True, eq=False)
class Pose:
    """Where something is and how it is turned: p_a = R p_b + position for a pose ``a_from_b``."""

    #: (3,) float64, metres.
    position: NDArray[np.float64]
    #: (4,) float64: the unit quaternion x, y, z, w of R.
    quaternion: NDArray[np.float64]

    @property
    def matrix(self) -> NDArray[np.float64]:
        """(4, 4): the same as a matrix for (x, y, z, 1)."""
        x, y, z, w = self.quaternion
        made = np.eye(4)
        made[:3, :3] = [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
        made[:3, 3] = self.position
        return made


@dataclass(frozen=True)
class Camera:
    """A camera's numbers, in SI units, and its pose in the scene frame."""

    width: int
    height: int
    #: x and y, metres.
    pixel_pitch: tuple[float, float]
    #: Metres.
    focal_length: float
    #: x and y, pixels from the outer corner of pixel (0, 0).
    principal_point: tuple[float, float]
    #: Metres.
    aperture: float
    transmission: float
    #: Metres along a ray.
    max_range: float
    scene_from_sensor: Pose


@dataclass(frozen=True)
class Beam:
    """A beam's numbers, in SI units, and its pose in the scene frame."""

    columns: int
    rows: int
    #: Metres.
    thickness: float
    #: Metres.
    grid_distance: float
    #: Metres.
    half_width: float
    #: Metres along a ray.
    max_range: float
    #: Watts.
    power: float
    #: Metres.
    wavelength: float
    scene_from_sensor: Pose


@dataclass(frozen=True)
class Returns:
    """Which returns of a beam with a width are told (docs/guide/lidar.md, "Returns")."""

    #: ``"first"``, ``"strongest"``, ``"last"``, or so many of the strongest.
    keep: str | int
    #: Gap between two returns, metres.
    separation_m: float


@dataclass(frozen=True, eq=False)
class RaySet:
    """A set of rays of a scene, in the scene frame, such as the pattern of a LiDAR."""

    #: (..., 8) float64: origin, direction, t_min, t_max; (..., 9), with t_blind, of a sensor that has a shortest range.
    #: ``cast(scene, ray_set.rays)`` answers them.
    rays: NDArray[np.float64]
    #: Seconds, (...); ``None`` if the rays have no times.
    times: NDArray[np.float64] | None
    #: Shares of a beam's power along the last dimension, if rays are parts of beams.
    weights: NDArray[np.float64] | None
    #: Which returns of a beam are told; ``None``: rays stand for themselves.
    returns: Returns | None
    #: Of a spinning head: the elevation of each channel, degrees.
    elevations_deg: NDArray[np.float64] | None
    #: Whether rays pass through the backs of faces.
    fronts_only: bool
    #: Share of the light that surfaces return.
    reflectivity: float = 1.0
    #: Extinction coefficient of the air, 1/m.
    extinction_per_m: float = 0.0

    def beam_returns(self, answers: CastResult) -> dict[str, NDArray[Any]]:
        """The returns of the beams, from the answers to their rays.

        Arrays by the names of the command's files without ``return.``: of beams (...) ``count``, ``mixed`` (boolean), ``share_missed``; of
        returns, (..., places) in the order of their ranges, ``number`` (0: none), ``ray``, ``range`` and ``mean_range`` (metres),
        ``strength``, ``share``, ``share_other``; of rays ``of_ray``. They hold what the files hold, to the last bit.

        Args:
            answers: ``cast(scene, ray_set.rays)``.

        Raises:
            RaypencilError: the set asks for no returns, or the answers are those of other rays.
        """
        if self.returns is None or self.weights is None:
            raise RaypencilError("the set asks for no returns: its cone has no `returns`")
        shape = self.rays.shape[:-1]
        if answers.shape != shape:
            raise RaypencilError(f"answers to rays of shape {answers.shape}; expected those of the set, {shape}")
        rows = (-1, shape[-1])
        return _raypencil.beam_returns(
            np.ascontiguousarray(answers.range.reshape(rows)),
            np.ascontiguousarray(answers.cos_incidence.reshape(rows)),
            self.weights.tolist(),
            list(shape[:-1]),
            self.returns.keep,
            self.returns.separation_m,
            (self.reflectivity, self.extinction_per_m),
        )


class Scene:
    """A scene. It never changes: :meth:`replace` makes another one.

    Args:
        source: a built-in ground (``pyramids``, ``facets``); a path to a scene file ``.toml``, a terrain (``.glb``, ``.gltf``,
            ``.stl``, ``.obj``, ``.ply``) or an elevation model ``.tif``; or the text of a scene file (what has a line break
            is a text); or a mesh in memory, as :func:`cast` takes it, in metres and z up: its vertices become offsets from an
            origin in single precision, as those of a file do.
        name: what messages and folders call a scene without a file.
        settings: keys of docs/guide/scene.md joined by dots, in the file's units:
            ``{"camera.pitch_down_deg": 25, "beam.0.thickness_mm": 4}``.
        progress: see :func:`cast`.
        tables: tables of a scene file: ``Scene(camera={"pitch_down_deg": 25}, beam=[{"rows": 8}])``. With a ``source`` they
            are settings of it. ``terrain`` may be a mesh in memory, in place of the ground that the source has.

    Raises:
        RaypencilError: a key that is not there, a value out of range: the message has the place in the file or the setting.
            If a file is not there, also a ``FileNotFoundError``.

    A scene can be pickled: by its source, whose files must be the same where it is unpickled. A mesh in memory goes along.
    """

    _core: _raypencil.SceneCore
    _source: str
    _is_text: bool
    _name: str
    _settings: tuple[tuple[str, str], ...]
    #: The file of a mesh in memory, if one is the ground.
    _ground: _GroundFile | None = None

    def __init__(
        self,
        source: Any = None,
        /,
        *,
        name: str = "scene",
        settings: Mapping[str, Any] | None = None,
        progress: Progress = False,
        **tables: Any,
    ) -> None:
        given = list(_toml.settings(settings or {}))
        if _is_mesh(tables.get("terrain")):
            ground = tables.pop("terrain")
            if _is_mesh(source):
                raise RaypencilError("the source and terrain are two meshes; expected one")
            if source is None:
                source = ground
            else:
                self._ground = _GroundFile(_ply(as_mesh(ground)), _checked(name))
                given = [self._ground.setting, *given]
        if _is_mesh(source):
            self._ground = _GroundFile(_ply(as_mesh(source)), _checked(name))
            source = self._ground.path
        if source is None:
            text, is_text = _toml.document(tables), True
        else:
            text = os.fspath(source)
            is_text = isinstance(source, str) and "\n" in text
            given = [*_toml.settings(tables), *given]
        _raypencil.refuse_contradictions(given)
        try:
            self._load(text, is_text, name, tuple(given), progress)
        except RaypencilError as error:
            if source is not None:
                raise
            # Nobody wrote the text: its lines are the keywords.
            raise type(error)(_toml.by_keyword(str(error), f"{name}.toml", tables, text)) from None

    def _load(
        self, source: str, is_text: bool, name: str, settings: tuple[tuple[str, str], ...], progress: Progress = False
    ) -> None:
        if is_text:
            _checked(name)
        self._source, self._is_text, self._name, self._settings = source, is_text, name, settings
        with stages(progress) as on_stage:
            self._core = _raypencil.SceneCore(source, is_text, name, list(settings), on_stage)

    def replace(self, settings: Mapping[str, Any] | None = None, /, **tables: Any) -> Scene:
        """The scene with other values: ``scene.replace({"camera.pitch_down_deg": 25, "beam.0.thickness_mm": 4})``.

        Args:
            settings: keys of docs/guide/scene.md joined by dots, in the file's units. ``beam.thickness_mm``, without a number,
                is for every beam.
            tables: the same as ``**{...}``, or tables as dictionaries: ``scene.replace(camera={"pitch_down_deg": 25})``.

        Raises:
            RaypencilError: a key that is not there, a value out of range.
        """
        scene = Scene.__new__(Scene)
        scene._ground = self._ground
        more = (*_toml.settings(settings or {}), *_toml.settings(tables))
        # What is given now holds over the scene's own settings, but not over one another.
        _raypencil.refuse_contradictions(list(more))
        scene._load(self._source, self._is_text, self._name, self._settings + more)
        return scene

    @property
    def toml(self) -> str:
        """The text of the scene file, before its :attr:`settings`; of a ground alone a text that stands for it."""
        if self._is_text:
            return self._source
        if self._source.lower().endswith(".toml"):
            with open(self._source, encoding="utf-8") as file:
                return file.read()
        key = "dem" if self._source.lower().endswith((".tif", ".tiff")) else "file"
        key = "builtin" if self._source in BUILTIN_NAMES else key
        return _toml.document({"terrain": {key: self._source}})

    @property
    def settings(self) -> dict[str, str]:
        """Keys that were set besides, each with its value as TOML."""
        return dict(self._settings)

    @property
    def name(self) -> str:
        """A short name, fit for a folder."""
        return self._core.name

    @property
    def sha256(self) -> str:
        """SHA-256 of the numbers of the scene, which packs and recordings name."""
        return self._core.sha256

    @property
    def source_sha256(self) -> str:
        """SHA-256 of the files or the text that define the scene."""
        return self._core.source_sha256

    @cached_property
    def mesh(self) -> Mesh:
        """The terrain, in the scene frame, metres."""
        return Mesh._of(self._core.mesh())

    @property
    def reflectivity(self) -> NDArray[np.float64]:
        """(m,): the reflectivity of each face, 0 to 1."""
        return self._core.reflectivity()

    @property
    def origin(self) -> NDArray[np.float64]:
        """(3,): global position of the origin of the scene frame, metres."""
        return self._core.origin

    @property
    def vehicle(self) -> Pose | None:
        """Pose of the vehicle, ``global_from_vehicle``; ``None`` if the scene has none."""
        pose = self._core.vehicle
        return None if pose is None else Pose(**pose)

    @property
    def camera(self) -> Camera:
        """The camera's numbers."""
        return Camera(**_posed(self._core.camera))

    @property
    def beams(self) -> list[Beam]:
        """The beams' numbers."""
        return [Beam(**_posed(beam)) for beam in self._core.beams]

    @property
    def ray_sets(self) -> dict[str, RaySet]:
        """The sets of rays of ``[[rays]]``, by name."""
        parts = ("rays", "times", "weights", "elevations_deg", "fronts_only", "reflectivity", "extinction_per_m")
        sets: dict[str, dict[str, Any]] = {
            name: {part: of.get(part) for part in parts} | {"returns": of.get("keep") and Returns(of["keep"], of["separation_m"])}
            for name, of in self._core.ray_sets.items()
        }
        return {name: RaySet(**of) for name, of in sets.items()}

    @property
    def flux_unit(self) -> str:
        """The unit of every flux: ``W``, or ``W/m`` with the paper's equation (1)."""
        return self._core.flux_unit

    def __repr__(self) -> str:
        camera = self.camera
        beams = f"{len(self._core.beams)} beams"
        return f"<raypencil.Scene {self._core.arguments}: {camera.width} x {camera.height} pixels, {beams}>"

    def __reduce__(self) -> tuple[Any, ...]:
        source = self._source
        if not self._is_text and source not in BUILTIN_NAMES:
            source = os.path.abspath(source)
        ground = None if self._ground is None else self._ground.content
        return _unpickled, (source, self._is_text, self._name, self._settings, self.source_sha256, ground)


def _posed(numbers: Mapping[str, Any]) -> dict[str, Any]:
    return {**numbers, "scene_from_sensor": Pose(**numbers["scene_from_sensor"])}


def _unpickled(
    source: str,
    is_text: bool,
    name: str,
    settings: tuple[tuple[str, str], ...],
    sha256: str,
    ground: bytes | None = None,
) -> Scene:
    scene = Scene.__new__(Scene)
    is_ground_a_setting = False
    if ground is not None:
        scene._ground = _GroundFile(ground, name)
        is_ground_a_setting = any(key == "terrain.file" for key, _ in settings)
        if is_ground_a_setting:
            settings = tuple(scene._ground.setting if one[0] == "terrain.file" else one for one in settings)
        else:
            source = scene._ground.path
    scene._load(source, is_text, name, settings)
    # The place of a mesh's file is another one.
    if scene.source_sha256 != sha256 and not is_ground_a_setting:
        raise RaypencilError(f"{source}: the scene is another one than that which was pickled; expected {sha256}")
    return scene


class _GroundFile:
    """A mesh in memory as a file, for as long as a scene has it."""

    def __init__(self, content: bytes, name: str) -> None:
        self._folder = tempfile.TemporaryDirectory(prefix="raypencil-")
        self.path = os.path.join(self._folder.name, f"{name}.ply")
        Path(self.path).write_bytes(content)

    @property
    def content(self) -> bytes:
        return Path(self.path).read_bytes()

    @property
    def setting(self) -> tuple[str, str]:
        """The key that makes it the ground."""
        return "terrain.file", _toml.value(self.path, "terrain.file")


def _is_mesh(given: Any) -> bool:
    return not (given is None or isinstance(given, (str, os.PathLike, Mapping, Scene)))


def _checked(name: str) -> str:
    if not name.replace("-", "").replace("_", "").replace(".", "").isalnum():
        raise RaypencilError(f"name is {name!r}; expected letters, digits, '-', '_' and '.'")
    return name


def _ply(mesh: Mesh) -> bytes:
    """A mesh as a binary PLY file, in double precision."""
    rows = np.empty(len(mesh.faces), dtype=[("count", "u1"), ("corners", "<u4", (3,))])
    rows["count"], rows["corners"] = 3, mesh.faces
    head = (
        "ply\nformat binary_little_endian 1.0\n"
        f"element vertex {len(mesh.vertices)}\nproperty double x\nproperty double y\nproperty double z\n"
        f"element face {len(mesh.faces)}\nproperty list uchar uint vertex_indices\nend_header\n"
    )
    return head.encode() + mesh.vertices.astype("<f8").tobytes() + rows.tobytes()


def as_scene(scene: Any) -> Scene:
    """A scene, or what :class:`Scene` takes in place of one."""
    return scene if isinstance(scene, Scene) else Scene(scene)


