"""Meshes."""

from __future__ import annotations

import os
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _arrays, _raypencil
from ._errors import RaypencilError
from ._progress import Progress, stages

Caster = Literal["referee", "tracer"]

#: More would be a mistake.
MAX_THREADS = 1024

#: The built-in grounds.
BUILTIN_NAMES = ("pyramids", "facets")


class Mesh:
    """Triangles with float64 vertices, in any frame and any unit. They never change.

    Args:
        vertices: (n, 3), real numbers within 1e30. Single precision is widened.
        faces: (m, 3), integers: the vertices of each triangle, from 0, counter-clockwise as seen from its front.

    Raises:
        RaypencilError: a vertex that is not finite, an index that is out of bounds, another shape or type.

    A mesh keeps the tree that its first rays had to build (:attr:`trees`): later calls only ask. It can be pickled, without its
    trees, and works in any number of threads.
    """

    __slots__ = ("_core",)
    _core: _raypencil.MeshCore

    def __init__(self, vertices: ArrayLike, faces: ArrayLike) -> None:
        points = _arrays.reals("vertices", vertices)
        if points.size == 0:
            points = points.reshape(0, 3)
        if points.ndim != 2 or points.shape[1] != 3:
            raise RaypencilError(f"vertices has the shape {points.shape}; expected (n, 3)")
        self._core = _raypencil.MeshCore(points, _arrays.faces("faces", faces))

    @classmethod
    def _of(cls, core: _raypencil.MeshCore) -> Mesh:
        mesh = cls.__new__(cls)
        mesh._core = core
        return mesh

    @property
    def vertices(self) -> NDArray[np.float64]:
        """(n, 3) float64, in the mesh's unit; read-only, not a copy."""
        return self._core.vertices

    @property
    def faces(self) -> NDArray[np.uint32]:
        """(m, 3) uint32; read-only, not a copy."""
        return self._core.faces

    @property
    def zero_area_faces(self) -> int:
        """Number of faces without an area. They are never hit."""
        return self._core.zero_area_faces

    @property
    def bounds(self) -> NDArray[np.float64] | None:
        """(2, 3): the smallest and the largest coordinates, in the mesh's unit; ``None`` without vertices."""
        if len(self.vertices) == 0:
            return None
        return np.stack([self.vertices.min(axis=0), self.vertices.max(axis=0)])

    @property
    def trees(self) -> tuple[Caster, ...]:
        """Whose trees are built and kept: none, or some of ``"referee"`` and ``"tracer"``."""
        both: tuple[Caster, ...] = ("referee", "tracer")
        return tuple(of for of in both if self._core.has_tree(of == "tracer"))

    def build(self, with_: Caster = "referee", *, threads: int | None = None, progress: Progress = False) -> Mesh:
        """Builds a tree now, if it is not built, and gives the mesh: ``mesh = load("yard.glb").build()``.

        Args:
            with_: whose tree.
            threads: how many threads build it; ``None``: all. The tree is the same.
            progress: see :func:`cast`.

        Raises:
            RaypencilError: a ``with_`` or a number of threads that is none.
        """
        by_tracer = is_tracer(with_)
        with stages(progress) as on_stage:
            self._core.build(by_tracer, number_of_threads(threads), on_stage)
        return self

    @property
    def open_edges(self) -> int:
        """Number of edges that are not run through once in each direction, vertices at one place taken as one: 0 if it is closed."""
        return self._core.count_open_edges()

    def save(self, folder: str | os.PathLike[str]) -> None:
        """Writes ``vertices.npy`` and ``faces.npy`` into a folder, which every command takes for a mesh.

        Args:
            folder: is made if it is not there.
        """
        os.makedirs(folder, exist_ok=True)
        np.save(os.path.join(folder, "vertices.npy"), self.vertices)
        np.save(os.path.join(folder, "faces.npy"), self.faces)

    def __repr__(self) -> str:
        built = f", tree of {' and '.join(self.trees)}" if self.trees else ""
        return f"<raypencil.Mesh: {len(self.vertices)} vertices, {len(self.faces)} faces{built}>"

    def __reduce__(self) -> tuple[Any, ...]:
        return Mesh, (np.array(self.vertices), np.array(self.faces))


def is_tracer(with_: str) -> bool:
    """Whether the tracer is asked, and not the referee."""
    if with_ not in ("referee", "tracer"):
        raise RaypencilError(f'with_ is {with_!r}; expected "referee" or "tracer"')
    return with_ == "tracer"


def number_of_threads(threads: int | None) -> int:
    """As the engine takes it: 0 is all."""
    if threads is None:
        return 0
    if isinstance(threads, bool) or not isinstance(threads, (int, np.integer)) or not 1 <= threads <= MAX_THREADS:
        raise RaypencilError(f"threads is {threads!r}; expected 1 to {MAX_THREADS}, or None for all")
    return int(threads)


def as_mesh(mesh: Any) -> Mesh:
    """A mesh; a scene's terrain; vertices and faces; a mesh of Open3D; or anything with ``vertices`` and ``faces``, such as one of
    trimesh."""
    if isinstance(mesh, Mesh):
        return mesh
    own = getattr(mesh, "mesh", None)
    if isinstance(own, Mesh):
        return own
    if isinstance(mesh, (tuple, list)) and len(mesh) == 2:
        return Mesh(mesh[0], mesh[1])
    if hasattr(mesh, "vertices") and hasattr(mesh, "faces"):
        return Mesh(mesh.vertices, mesh.faces)
    # Open3D's open3d.geometry.TriangleMesh, and then its open3d.t.geometry.TriangleMesh.
    if hasattr(mesh, "vertices") and hasattr(mesh, "triangles"):
        return Mesh(np.asarray(mesh.vertices), np.asarray(mesh.triangles))
    if hasattr(mesh, "vertex") and hasattr(mesh, "triangle"):
        return Mesh(*(tensor.cpu().numpy() for tensor in (mesh.vertex["positions"], mesh.triangle["indices"])))
    raise RaypencilError(
        f"mesh is of type {type(mesh).__name__}; expected a Mesh, (vertices, faces), or what has vertices and faces"
    )


def load_mesh(path: str | os.PathLike[str], *, progress: Progress = False) -> Mesh:
    """Reads the triangles of a file, with the numbers that it gives: no axis is turned, no origin subtracted.

    Args:
        path: ``.glb``, ``.gltf``, ``.stl``, ``.obj`` or ``.ply``, or a folder with ``vertices.npy`` and ``faces.npy``.
        progress: see :func:`cast`.

    Raises:
        RaypencilError: what is wrong with the file, and where. If it is not there, also a ``FileNotFoundError``.
    """
    with stages(progress) as on_stage:
        return Mesh._of(_raypencil.load_mesh(os.fspath(path), on_stage))
