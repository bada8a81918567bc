"""trimesh: its own test, and its rays by Embree."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from ..._judge import Arithmetic
from ..._mesh import Mesh
from .._peer import Built, Hits, Peer, Rays, Unavailable, hits, need


_AS_LONG = "make directions as long as the way to the mesh, and scale t"


class Trimesh(Peer):
    """`ray_triangle.RayMeshIntersector`: candidates by an R-tree, planes and barycentric weights in NumPy."""

    name, title, package = "trimesh", "trimesh", "trimesh"
    arithmetic: ClassVar[Arithmetic] = "f64"
    mesh_type: ClassVar[Arithmetic] = "f64"
    rays_type: ClassVar[Arithmetic] = "f64"
    causes: ClassVar[tuple[str, ...]] = (
        "`planes_lines` (intersections.py) drops rays whose direction times the face's unit normal is at most 1e-05; `unitize` (util.py),"
        " which makes that normal, takes a cross product at most 1e-13 long for 0.",
        "`ray_bounds` (ray/ray_triangle.py) looks for faces from t = 1e-05 on, and 1e-05 around: with a long direction what is nearer is"
        " lost.",
        "Of hits whose points agree to 1e-08 `intersects_id(..., return_locations=True)` keeps one, which may be the farther one"
        " (`unique_rows`, grouping.py): so on *nearly-coincident*, of which `intersects_first` loses one.",
        "`points_to_barycentric` (triangles.py) subtracts products of squared edges, which cancel on thin faces.",
    )
    advice: ClassVar[tuple[str, ...]] = ("ask `intersects_first` where the nearest face is enough",)
    remedies: ClassVar[Mapping[tuple[str, str], str]] = {
        ("angle", "below"): "make directions longer for grazing rays, while no hit is nearer than 1e-05 of them",
        ("length", "below"): _AS_LONG,
        ("length", "above"): _AS_LONG,
    }
    module = "trimesh.ray.ray_triangle"

    def build(self, mesh: Mesh) -> Built:
        made = need("trimesh", self.package).Trimesh(mesh.vertices, mesh.faces, process=False, validate=False)
        return need(self.module, self.package).RayMeshIntersector(made)

    def all_of(self, built: Built, rays: Rays) -> list[list[tuple[int, float]]]:
        """All hits of each ray, in order of t."""
        faces, index, points = built.intersects_id(rays[:, 0:3], rays[:, 3:6], return_locations=True, multiple_hits=True)
        found: defaultdict[int, list[tuple[float, int]]] = defaultdict(list)
        for face, ray, point in zip(faces, index, points, strict=True):
            # A point tells t best along the direction's largest part.
            axis = int(np.argmax(np.abs(rays[ray, 3:6])))
            t = float((point[axis] - rays[ray, axis]) / rays[ray, 3 + axis])
            if 0 <= t <= rays[ray, 7]:
                found[int(ray)].append((t, int(face)))
        return [[(face, t) for t, face in sorted(found[ray])] for ray in range(len(rays))]

    def shoot(self, built: Built, rays: Rays) -> Hits:
        firsts = [(one[0] if one else (-1, np.inf)) for one in self.all_of(built, rays)]
        return hits([face for face, _ in firsts], [t for _, t in firsts], rays)

    def any(self, mesh: Mesh, rays: Rays) -> NDArray[np.bool_] | None:
        return np.asarray(self.build(mesh).intersects_any(rays[:, 0:3], rays[:, 3:6]), dtype=bool)

    def all(self, mesh: Mesh, rays: Rays) -> list[list[tuple[int, float]]] | None:
        return self.all_of(self.build(mesh), rays)


class TrimeshEmbree(Trimesh):
    """`ray_pyembree.RayMeshIntersector`, which trimesh takes where embreex is installed."""

    name, title = "trimesh-embree", "trimesh with Embree"
    arithmetic = "f32"
    mesh_type = "f32"
    rays_type = "f32"
    conventions = (
        "Faces with their points are asked (`intersects_id(..., return_locations=True)`), for t is that of the point;"
        " `intersects_first` tells faces alone, and is not concerned by the size of the mesh.",
    )
    causes = (
        "`unitize` (util.py), which makes the faces' normals and the directions 1 long, takes a vector at most 1e-13 long for 0; without a"
        " normal a face has no points.",
        "`planes_lines` (intersections.py), which makes the points, drops those of rays at 1e-05 radians or less to the face: so all of"
        " *grazing*, which single precision excuses.",
    )
    advice = ("ask `intersects_first` where faces are enough",)
    remedies: ClassVar[Mapping[tuple[str, str], str]] = {}
    module = "trimesh.ray.ray_pyembree"

    def build(self, mesh: Mesh) -> Built:
        if not need(self.module, "trimesh embreex").__dict__.get("rtcore_scene"):
            raise Unavailable("trimesh has no Embree: pip install embreex")
        return super().build(mesh)

    def shoot(self, built: Built, rays: Rays) -> Hits:
        # One hit of each ray is what it asks Embree; the points come from trimesh.
        face, index, points = built.intersects_id(rays[:, 0:3], rays[:, 3:6], return_locations=True, multiple_hits=False)
        faces, ts = np.full(len(rays), -1), np.full(len(rays), np.inf)
        for one, ray, point in zip(face, index, points, strict=True):
            axis = int(np.argmax(np.abs(rays[ray, 3:6])))
            faces[ray], ts[ray] = one, (point[axis] - rays[ray, axis]) / rays[ray, 3 + axis]
        return hits(faces, ts, rays)
