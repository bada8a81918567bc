"""A drop-in for Open3D's rays, with exact answers: ``scene = raypencil.open3d.RaycastingScene()``.

Methods, names and shapes are those of ``open3d.t.geometry.RaycastingScene``. Arrays are of NumPy, and t, weights and normals are
doubles. What differs is what is right: no ray slips through an edge, none is lost far away or at a grazing angle, and what is
inside is counted exactly. Open3D's distances and closest points are no rays, and are not here.
"""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _arrays
from ._arrays import NO_FACE
from ._cast import Asked
from ._cast_result import AllHits, CastResult, rays_and_places
from ._errors import RaypencilError, RaypencilWarning
from ._mesh import Mesh, as_mesh

__all__ = ["RaycastingScene"]

#: Along no axis and no usual edge: fewer rays meet edges, which take longer.
_ANY_DIRECTION = (0.41, 0.29, 0.87)


class RaycastingScene:
    """Triangle meshes, and the rays on all of them.

    Args:
        nthreads: how many threads answer, unless a call says otherwise; 0: all.
    """

    #: What stands for no geometry and no triangle.
    INVALID_ID = NO_FACE

    def __init__(self, nthreads: int = 0) -> None:
        self._threads = nthreads
        self._meshes: list[Mesh] = []
        self._together: Mesh | None = None

    def add_triangles(self, vertex_positions: Any, triangle_indices: ArrayLike | None = None) -> int:
        """Adds a mesh, and returns its ``geometry_id``: 0 for the first.

        Args:
            vertex_positions: (n, 3), in double precision as they are; or, alone, a mesh as for :func:`raypencil.cast`.
            triangle_indices: (m, 3).

        Raises:
            RaypencilError: as :class:`raypencil.Mesh`.
        """
        alone = triangle_indices is None
        self._meshes.append(as_mesh(vertex_positions) if alone else Mesh(vertex_positions, triangle_indices))  # type: ignore[arg-type]
        self._together = None
        return len(self._meshes) - 1

    def cast_rays(self, rays: ArrayLike, nthreads: int | None = None) -> dict[str, NDArray[Any]]:
        """The first hit of each ray.

        Args:
            rays: (..., 6): origins and directions, whose length counts.
            nthreads: how many threads answer; 0: all.

        Returns:
            ``t_hit`` (...), infinite where nothing is hit; ``geometry_ids``, ``primitive_ids`` (...), 4294967295 where nothing is
            hit; ``primitive_uvs`` (..., 2), the weights of the second and the third corner, and ``primitive_normals`` (..., 3),
            of length 1, both 0 where nothing is hit.

        Raises:
            RaypencilError: rays of another shape, and the first ray that is none.
        """
        first = self._cast(rays, nthreads, values=("t", "barycentric", "normal"))
        is_hit = first.hit[..., np.newaxis]
        geometry, primitive = self._ids(first.face)
        return {
            "t_hit": np.array(first.t),
            "geometry_ids": geometry,
            "primitive_ids": primitive,
            "primitive_uvs": np.where(is_hit, first.barycentric[..., 1:3], 0.0),
            "primitive_normals": np.where(is_hit, first.normal, 0.0),
        }

    def test_occlusions(
        self, rays: ArrayLike, tnear: float = 0.0, tfar: float = np.inf, nthreads: int | None = None
    ) -> NDArray[np.bool_]:
        """Whether each ray hits anything, (...).

        Args:
            rays: (..., 6).
            tnear, tfar: the ends of the rays, which belong to them.
            nthreads: how many threads answer; 0: all.

        Raises:
            RaypencilError: as :meth:`cast_rays`.
        """
        found = self._cast(rays, nthreads, "any", ends=(tnear, tfar)).any
        assert found is not None
        return found.astype(bool)

    def count_intersections(self, rays: ArrayLike, nthreads: int | None = None) -> NDArray[np.int32]:
        """In how many places each ray meets the triangles, (...): an edge or a corner that several share is one place.

        Args:
            rays: (..., 6).
            nthreads: how many threads answer; 0: all.

        Raises:
            RaypencilError: as :meth:`cast_rays`.
        """
        told = self._cast(rays, nthreads, "all")
        hits = _all(told)
        index_ray, begins = rays_and_places(hits)
        return np.bincount(index_ray[begins], minlength=len(told)).astype(np.int32).reshape(told.shape)

    def list_intersections(self, rays: ArrayLike, nthreads: int | None = None) -> dict[str, NDArray[Any]]:
        """All triangles that each ray meets, in exact order; at the same t by their index.

        Args:
            rays: (..., 6).
            nthreads: how many threads answer; 0: all.

        Returns:
            ``ray_splits`` (n + 1,): the entries of ray k are ``ray_splits[k]`` to ``ray_splits[k + 1] - 1``; and for each entry
            ``ray_ids``, ``t_hit``, ``geometry_ids``, ``primitive_ids``, ``primitive_uvs`` (h, 2).

        Raises:
            RaypencilError: as :meth:`cast_rays`.
        """
        parts = self._rays(rays)
        hits = _all(self._cast(rays, nthreads, "all"))
        index_ray, _ = rays_and_places(hits)
        geometry, primitive = self._ids(hits.face)
        return {
            "ray_splits": hits.start.astype(np.int64),
            "ray_ids": index_ray,
            "t_hit": np.array(hits.t),
            "geometry_ids": geometry,
            "primitive_ids": primitive,
            "primitive_uvs": self._uvs(parts.whole()[index_ray], hits),
        }

    def compute_occupancy(
        self, query_points: ArrayLike, nthreads: int | None = None, nsamples: int = 1
    ) -> NDArray[np.float32]:
        """1 for points inside, 0 for points outside, (...): whether the meshes wind around them, counted exactly along one ray.

        Points on the surface may be either. Of an open mesh it is told how often the one ray crosses it, and warned.

        Args:
            query_points: (..., 3).
            nthreads: how many threads answer; 0: all.
            nsamples: in Open3D the number of rays that vote. An exact count needs no vote: it changes nothing.

        Raises:
            RaypencilError: points of another shape.

        Warns:
            RaypencilWarning: the number of open edges, if there are any.
        """
        points = _arrays.vectors("query_points", query_points)
        directions = np.broadcast_to(_ANY_DIRECTION, points.shape)
        told = self._cast(np.concatenate([points, directions], axis=-1), nthreads, "all")
        if open_edges := self._mesh().open_edges:
            edges = "1 open edge" if open_edges == 1 else f"{open_edges} open edges"
            sentence = f"the meshes have {edges}: they have an inside only where they are closed"
            warnings.warn(sentence, RaypencilWarning, stacklevel=2)
        hits = _all(told)
        assert hits.crossing is not None
        index_ray, begins = rays_and_places(hits)
        crossings = np.bincount(index_ray[begins], weights=hits.crossing[begins], minlength=len(told))
        return np.asarray(crossings != 0, dtype=np.float32).reshape(told.shape)

    def _mesh(self) -> Mesh:
        """All meshes as one, which keeps its tree until another is added."""
        if self._together is None:
            if len(self._meshes) == 1:
                self._together = self._meshes[0]
            else:
                before = np.cumsum([0, *(len(mesh.vertices) for mesh in self._meshes)])
                vertices = [np.zeros((0, 3)), *(mesh.vertices for mesh in self._meshes)]
                faces = [mesh.faces.astype(np.int64) + at for mesh, at in zip(self._meshes, before, strict=False)]
                self._together = Mesh(np.concatenate(vertices), np.concatenate([np.zeros((0, 3), np.int64), *faces]))
        return self._together

    def _ids(self, faces: NDArray[np.uint32]) -> tuple[NDArray[np.uint32], NDArray[np.uint32]]:
        """The mesh of each face, and the face's index there."""
        ends = np.cumsum([0, *(len(mesh.faces) for mesh in self._meshes)])
        geometry = np.searchsorted(ends, faces, side="right") - 1
        is_hit = faces != NO_FACE
        primitive = faces - ends[np.where(is_hit, geometry, 0)]
        no = self.INVALID_ID
        return np.where(is_hit, geometry, no).astype(np.uint32), np.where(is_hit, primitive, no).astype(np.uint32)

    def _rays(self, rays: ArrayLike) -> _arrays.RayParts:
        numbers = _arrays.reals("rays", rays)
        if numbers.ndim == 0 or numbers.shape[-1] != 6:
            raise RaypencilError(f"rays have the shape {numbers.shape}; expected (..., 6)")
        return _arrays.RayParts(numbers, None)

    def _cast(
        self,
        rays: ArrayLike,
        nthreads: int | None,
        query: Any = "first",
        values: tuple[str, ...] = (),
        ends: tuple[float, float] = (0.0, np.inf),
    ) -> CastResult:
        parts = self._rays(rays)
        origin, direction, *_ = parts.parts
        threads = self._threads if nthreads is None else nthreads
        asked = Asked(query, values, threads=None if threads == 0 else threads)
        return asked.of(self._mesh()._core, _arrays.RayParts(origin, direction, *ends))

    def _uvs(self, rays: NDArray[np.float64], hits: AllHits) -> NDArray[np.float64]:
        """The weights of two corners at each hit, in doubles: those of the place at the hit's t."""
        mesh = self._mesh()
        a, b, c = (mesh.vertices[mesh.faces[hits.face, corner]] for corner in range(3))
        place = rays[:, 0:3] + hits.t[:, np.newaxis] * rays[:, 3:6]
        normal = np.cross(b - a, c - a)
        square = np.einsum("ij,ij->i", normal, normal)
        u = np.einsum("ij,ij->i", np.cross(place - a, c - a), normal) / square
        v = np.einsum("ij,ij->i", np.cross(b - a, place - a), normal) / square
        return np.stack([u, v], axis=-1)


def _all(told: CastResult) -> AllHits:
    hits = told.all
    assert hits is not None
    return hits
