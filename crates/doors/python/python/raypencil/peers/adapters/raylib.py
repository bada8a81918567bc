"""raylib."""

from __future__ import annotations

import numpy as np

from ..._mesh import Mesh
from .._peer import Built, Hits, Peer, Rays, hits, need


class Raylib(Peer):
    """`GetRayCollisionTriangle` on every face: `GetRayCollisionMesh` does the same, and tells no face."""

    name, title, package = "raylib", "raylib", "raylib"
    arithmetic = mesh_type = rays_type = "f32"
    is_unit = True
    causes = (
        "`GetRayCollisionTriangle` (src/rmodels.c) takes a determinant below 1e-06 for 0, and a hit nearer than 1e-06 for none"
        " (`EPSILON`).",
    )
    is_brute_force = True

    def build(self, mesh: Mesh) -> Built:
        pyray = need("pyray", self.package)
        corners = [pyray.Vector3(*corner) for corner in mesh.vertices.tolist()]
        return pyray, [[corners[i] for i in face] for face in mesh.faces.tolist()]

    def shoot(self, built: Built, rays: Rays) -> Hits:
        pyray, faces = built
        face, t = np.full(len(rays), -1), np.full(len(rays), np.inf)
        for k, ray in enumerate(rays.tolist()):
            asked = pyray.Ray(pyray.Vector3(*ray[0:3]), pyray.Vector3(*ray[3:6]))
            for number, corners in enumerate(faces):
                found = pyray.get_ray_collision_triangle(asked, *corners)
                if found.hit and found.distance < t[k]:
                    face[k], t[k] = number, found.distance
        return hits(face, t, rays)
