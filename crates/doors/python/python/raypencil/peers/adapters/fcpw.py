"""FCPW."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

import numpy as np

from ..._mesh import Mesh
from .._peer import Built, Hits, Peer, Rays, hits, need, single


class Fcpw(Peer):
    """`scene_3D.intersect` on a vectorised tree."""

    name, title, package = "fcpw", "FCPW", "fcpw"
    arithmetic = mesh_type = rays_type = "f32"
    is_unit = True
    causes = (
        "Its test of triangles takes a determinant below 1.2e-07, the epsilon of single precision, for 0 (`Triangle::intersect`,"
        " include/fcpw/geometry/triangles.inl).",
    )
    remedies: ClassVar[Mapping[tuple[str, str], str]] = {
        ("scale", "below"): "make directions 1e12 long on a small mesh, and scale t: the determinant grows with them",
    }

    def build(self, mesh: Mesh) -> Built:
        fcpw = need("fcpw", self.package)
        scene = fcpw.scene_3D()
        scene.set_object_count(1)
        scene.set_object_vertices(np.asfortranarray(single(mesh.vertices)), 0)
        scene.set_object_triangles(np.asfortranarray(mesh.faces.astype(np.int32)), 0)
        scene.build(fcpw.aggregate_type.bvh_surface_area, True, False, False)
        return fcpw, scene

    def shoot(self, built: Built, rays: Rays) -> Hits:
        fcpw, scene = built
        told = fcpw.interaction_3D_list()
        ends = np.minimum(rays[:, 7], float(np.finfo(np.float32).max))
        scene.intersect(np.asfortranarray(single(rays[:, 0:3])), np.asfortranarray(single(rays[:, 3:6])), single(ends), told)
        face = np.array([one.primitive_index for one in told], dtype=np.int64)
        return hits(face, [one.d for one in told], rays, is_hit=(face >= 0) & (face < 2**31 - 1))
