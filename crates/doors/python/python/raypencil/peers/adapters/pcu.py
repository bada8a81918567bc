"""point-cloud-utils, which asks Embree."""

from __future__ import annotations

import numpy as np

from ..._mesh import Mesh
from .._peer import Built, Hits, Peer, Rays, hits, need, single
from .embree import SHORT_PARTS


class PointCloudUtils(Peer):
    """`RayMeshIntersector.intersect_rays`."""

    name, title, package = "pcu", "point-cloud-utils", "point-cloud-utils"
    causes = (SHORT_PARTS,)
    arithmetic = mesh_type = rays_type = "f32"

    def build(self, mesh: Mesh) -> Built:
        pcu = need("point_cloud_utils", self.package)
        return pcu.RayMeshIntersector(single(mesh.vertices), mesh.faces.astype(np.int32))

    def shoot(self, built: Built, rays: Rays) -> Hits:
        face, _, t = built.intersect_rays(single(rays[:, 0:3]), single(rays[:, 3:6]))
        return hits(face, t, rays)
