"""A drop-in for trimesh's own rays, with exact answers: ``mesh.ray = raypencil.trimesh.RayMeshIntersector(mesh)``.

Signatures and shapes are those of ``trimesh.ray.ray_triangle.RayMeshIntersector``. What differs is what is right: there is
no threshold, so that hits at an edge, at a grazing angle, on a tiny mesh or far away are neither lost nor made up, and no hit
behind a ray's origin is told.
"""

from __future__ import annotations

from copy import deepcopy
from typing import Any, Literal, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _arrays
from ._arrays import NO_FACE
from ._cast import answered
from ._cast_result import CastResult, rays_and_places
from ._errors import RaypencilError
from ._mesh import Caster, Mesh, as_mesh

__all__ = ["RayMeshIntersector"]

_Index = NDArray[np.int64]
_Points = NDArray[np.float64]


class RayMeshIntersector:
    """Rays on a mesh.

    A copy of a mesh by ``mesh.copy()`` has trimesh's own rays again, for trimesh makes it from nothing. ``copy.copy(mesh.ray)`` has the
    same mesh as this one, ``mesh.ray.copy()`` and ``copy.deepcopy(mesh.ray)`` have a copy of it, whose ``ray`` they are.

    Args:
        mesh: a ``trimesh.Trimesh``, or anything with ``vertices`` (n, 3) and ``faces`` (m, 3). A mesh of trimesh may change:
            it is looked at again for each call.
        scale_to_box: trimesh's argument for Embree, which changes nothing here: no mesh is too small or too large.
        with_: ``"referee"`` is exact; ``"tracer"`` is 1.2 to 3.2 times as fast (docs/evidence/speed.md) and rounds. It answers
            :meth:`intersects_first` and :meth:`intersects_any`; the others are exact in any case.
        geometry: the mesh by the name that it has in ``trimesh.ray.ray_pyembree``.

    Raises:
        RaypencilError: no mesh is given, or two.
    """

    def __init__(
        self, mesh: Any = None, scale_to_box: bool = True, *, with_: Caster = "referee", geometry: Any = None
    ) -> None:
        if (mesh is None) == (geometry is None):
            raise RaypencilError(f"{'no mesh is' if mesh is None else 'two meshes are'} given; expected mesh or geometry")
        self.mesh = geometry if mesh is None else mesh
        self._with: Caster = with_
        self._kept: tuple[int, Mesh] | None = None

    def copy(self) -> RayMeshIntersector:
        """The same rays on a copy of the mesh. A mesh of trimesh has them as its ``ray``."""
        # A mesh of raypencil never changes.
        if isinstance(self.mesh, Mesh):
            return RayMeshIntersector(self.mesh, with_=self._with)
        mesh = self.mesh.copy() if hasattr(self.mesh, "copy") else deepcopy(self.mesh)
        copied = RayMeshIntersector(mesh, with_=self._with)
        if hasattr(mesh, "ray"):
            mesh.ray = copied
        return copied

    def __copy__(self) -> RayMeshIntersector:
        return RayMeshIntersector(self.mesh, with_=self._with)

    def __deepcopy__(self, memo: dict[int, Any]) -> RayMeshIntersector:
        copied = self.copy()
        memo[id(self)] = copied
        return copied

    def _mesh(self) -> Mesh:
        if isinstance(self.mesh, Mesh):
            return self.mesh
        # The number that trimesh makes of vertices and faces, quickly. Other meshes have none that follows their changes.
        if not hasattr(self.mesh, "triangles"):
            return as_mesh(self.mesh)
        key = hash(self.mesh)
        if self._kept is None or self._kept[0] != key:
            self._kept = key, as_mesh(self.mesh)
        return self._kept[1]

    def _cast(
        self, origins: ArrayLike, directions: ArrayLike, query: Literal["first", "any", "all"], *values: str
    ) -> CastResult:
        origin, direction = np.asanyarray(origins, dtype=np.float64), np.asanyarray(directions, dtype=np.float64)
        if origin.size == 0 and direction.size == 0:
            origin, direction = np.zeros((0, 3)), np.zeros((0, 3))
        if origin.ndim != 2 or origin.shape != direction.shape or origin.shape[1] != 3:
            raise RaypencilError(f"rays are {origin.shape} and {direction.shape}; expected (m, 3) twice")
        with_: Caster = "referee" if query == "all" else self._with
        return answered(self._mesh(), _arrays.RayParts(origin, direction), query, with_, values)

    @overload
    def intersects_id(
        self,
        ray_origins: ArrayLike,
        ray_directions: ArrayLike,
        return_locations: Literal[False] = False,
        multiple_hits: bool = True,
        **kwargs: Any,
    ) -> tuple[_Index, _Index]: ...

    @overload
    def intersects_id(
        self,
        ray_origins: ArrayLike,
        ray_directions: ArrayLike,
        return_locations: Literal[True],
        multiple_hits: bool = True,
        **kwargs: Any,
    ) -> tuple[_Index, _Index, _Points]: ...

    def intersects_id(
        self,
        ray_origins: ArrayLike,
        ray_directions: ArrayLike,
        return_locations: bool = False,
        multiple_hits: bool = True,
        **kwargs: Any,
    ) -> tuple[_Index, _Index] | tuple[_Index, _Index, _Points]:
        """The triangles that rays hit.

        Args:
            ray_origins, ray_directions: (m, 3).
            return_locations: return locations besides, each once: of several triangles at one point the lowest index.
            multiple_hits: all hits, by ray and then in exact order; otherwise the first of each ray.
            kwargs: trimesh's other arguments, which change nothing here.

        Returns:
            ``index_triangle`` (h,), ``index_ray`` (h,), and if asked ``locations`` (h, 3).
        """
        if not multiple_hits:
            first = self._cast(ray_origins, ray_directions, "first", "point")
            index_ray = np.flatnonzero(first.hit)
            index_tri = first.face[index_ray].astype(np.int64)
            if return_locations:
                return index_tri, index_ray, np.array(first.point[index_ray]).reshape(-1, 3)
            return index_tri, index_ray
        answers = self._cast(ray_origins, ray_directions, "all", *(["point"] if return_locations else []))
        hits = answers.all
        assert hits is not None
        index_ray, begins = rays_and_places(hits)
        index_tri = hits.face.astype(np.int64)
        if not return_locations:
            return index_tri, index_ray
        # One location for each group: its first entry, which has the lowest face.
        index_tri, index_ray, t = index_tri[begins], index_ray[begins], hits.t[begins]
        origin, direction = (np.asanyarray(of, dtype=np.float64).reshape(-1, 3) for of in (ray_origins, ray_directions))
        locations = origin[index_ray] + t[:, np.newaxis] * direction[index_ray]
        # The first of each ray is known exactly.
        is_first = hits.group[begins] == 0
        locations[is_first] = answers.point[index_ray[is_first]]
        return index_tri, index_ray, locations

    def intersects_location(
        self, ray_origins: ArrayLike, ray_directions: ArrayLike, **kwargs: Any
    ) -> tuple[_Points, _Index, _Index]:
        """The places where rays hit the mesh, each once.

        Args:
            ray_origins, ray_directions: (m, 3).
            kwargs: ``multiple_hits`` as for :meth:`intersects_id`; trimesh's other arguments change nothing here.

        Returns:
            ``locations`` (h, 3), ``index_ray`` (h,), ``index_tri`` (h,).
        """
        multiple = bool(kwargs.get("multiple_hits", True))
        index_tri, index_ray, locations = self.intersects_id(
            ray_origins, ray_directions, return_locations=True, multiple_hits=multiple
        )
        return locations, index_ray, index_tri

    def intersects_first(self, ray_origins: ArrayLike, ray_directions: ArrayLike, **kwargs: Any) -> _Index:
        """(m,): the first triangle that each ray hits, -1 if none.

        Args:
            ray_origins, ray_directions: (m, 3).
            kwargs: trimesh's other arguments, which change nothing here.
        """
        face = self._cast(ray_origins, ray_directions, "first", "face").face
        return np.where(face == NO_FACE, -1, face.astype(np.int64))

    def intersects_any(self, ray_origins: ArrayLike, ray_directions: ArrayLike, **kwargs: Any) -> NDArray[np.bool_]:
        """(m,): whether each ray hits anything.

        Args:
            ray_origins, ray_directions: (m, 3).
            kwargs: trimesh's other arguments, which change nothing here.
        """
        found = self._cast(ray_origins, ray_directions, "any").any
        assert found is not None
        return found.astype(bool)

    def contains_points(self, points: ArrayLike) -> NDArray[np.bool_]:
        """(n,): whether points are inside of a closed mesh: whether it winds around them.

        It is counted exactly along one ray for each point, also where the ray meets edges and vertices. Points on the surface
        may be either.

        Args:
            points: (n, 3).

        Raises:
            RaypencilError: points of another shape.
        """
        places = np.asanyarray(points, dtype=np.float64)
        if places.size == 0:
            return np.zeros(0, dtype=bool)
        if places.ndim != 2 or places.shape[1] != 3:
            raise RaypencilError(f"points have the shape {places.shape}; expected (n, 3)")
        # Any direction will do; along one that is no axis fewer rays meet edges, which take longer.
        hits = self._cast(places, np.broadcast_to([0.41, 0.29, 0.87], places.shape), "all").all
        assert hits is not None and hits.crossing is not None
        index_ray, begins = rays_and_places(hits)
        crossings = np.bincount(index_ray[begins], weights=hits.crossing[begins], minlength=len(places))
        return np.asarray(crossings != 0)
