"""Raysect."""

from __future__ import annotations

import numpy as np

from ..._mesh import Mesh
from .._peer import Built, Hits, Peer, Rays, hits, need


class Raysect(Peer):
    """`Mesh.hit`: vertices in single precision, Woop's watertight test, unit directions."""

    name, title, package = "raysect", "Raysect", "raysect"
    arithmetic = mesh_type = "f32"
    rays_type = "f64"
    is_unit = True
    conventions = ("It leaves out faces without an area; with `tolerant=False` it refuses them.",)

    def build(self, mesh: Mesh) -> Built:
        core, primitive = need("raysect.core", self.package), need("raysect.primitive", self.package)
        world = core.World()
        made = primitive.Mesh(mesh.vertices, mesh.faces, closed=False, smoothing=False, tolerant=True, parent=world)
        # The world's own tree is not asked; the mesh is.
        return core, made, world

    def shoot(self, built: Built, rays: Rays) -> Hits:
        core, mesh, _ = built
        face, t = np.full(len(rays), -1), np.full(len(rays), np.inf)
        for k, ray in enumerate(rays.tolist()):
            found = mesh.hit(core.Ray(core.Point3D(*ray[0:3]), core.Vector3D(*ray[3:6]), ray[7]))
            if found is not None:
                face[k], t[k] = found.triangle, found.ray_distance
        return hits(face, t, rays)
