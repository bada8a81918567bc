"""ncollpyde, which asks parry."""

from __future__ import annotations

import numpy as np

from ..._mesh import Mesh
from .._peer import Built, Hits, Peer, Rays, hits, need, segment_length


class Ncollpyde(Peer):
    """`Volume.intersections`, which takes segments and tells points, no face."""

    name, title, package = "ncollpyde", "ncollpyde", "ncollpyde"
    arithmetic = mesh_type = rays_type = "f64"
    is_segment = True
    conventions = ("It tells points, no faces and no t; t is that of the point.",)

    def build(self, mesh: Mesh) -> Built:
        made = need("ncollpyde", self.package).Volume(mesh.vertices, mesh.faces, validate=False, n_rays=0)
        return made, np.array(mesh.vertices)

    def shoot(self, built: Built, rays: Rays) -> Hits:
        volume, vertices = built
        length = segment_length(vertices, rays)
        ends = rays[:, 0:3] + length[:, None] * rays[:, 3:6]
        index, points, _ = volume.intersections(rays[:, 0:3], ends, threads=False)
        t = np.full(len(rays), np.inf)
        for ray, point in zip(index, points, strict=True):
            axis = int(np.argmax(np.abs(rays[ray, 3:6])))
            t[ray] = (point[axis] - rays[ray, axis]) / rays[ray, 3 + axis]
        return hits(None, t, rays)
