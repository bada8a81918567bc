"""PyBullet."""

from __future__ import annotations

import numpy as np

from ..._mesh import Mesh
from .._peer import Built, Hits, Peer, Rays, hits, need, segment_length


class PyBullet(Peer):
    """`rayTest` on a concave mesh that does not move: Bullet's `btBvhTriangleMeshShape`. It tells no face."""

    name, title, package = "pybullet", "PyBullet", "pybullet"
    arithmetic = mesh_type = rays_type = "f64"
    is_segment = True
    conventions = ("It tells no face; t alone is judged.",)

    def build(self, mesh: Mesh) -> Built:
        bullet = need("pybullet", self.package)
        bullet.disconnect() if bullet.isConnected() else None
        bullet.connect(bullet.DIRECT)
        shape = bullet.createCollisionShape(
            bullet.GEOM_MESH,
            vertices=mesh.vertices.tolist(),
            indices=mesh.faces.ravel().tolist(),
            flags=bullet.GEOM_FORCE_CONCAVE_TRIMESH,
        )
        bullet.createMultiBody(0, shape)
        return bullet, np.array(mesh.vertices)

    def shoot(self, built: Built, rays: Rays) -> Hits:
        bullet, vertices = built
        length = segment_length(vertices, rays)
        ends = rays[:, 0:3] + length[:, None] * rays[:, 3:6]
        told = [bullet.rayTest(start, end)[0] for start, end in zip(rays[:, 0:3].tolist(), ends.tolist(), strict=True)]
        return hits(None, np.array([one[2] for one in told]) * length, rays, is_hit=[one[0] >= 0 for one in told])
