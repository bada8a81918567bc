"""pyraymesh, which asks the C++ library bvh."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..._mesh import Mesh
from .._peer import Built, Hits, Peer, Rays, hits, need, single


class PyRayMesh(Peer):
    """`Mesh.intersect` on a tree of its middle quality, with the robust traversal that it takes by itself."""

    name, title, package = "pyraymesh", "bvh (C++), by pyraymesh", "pyraymesh"
    conventions = ("`tri_ids` are the places of the faces in its tree, not their numbers; so t alone is judged.",)
    arithmetic = mesh_type = rays_type = "f32"

    def build(self, mesh: Mesh) -> Built:
        made = need("pyraymesh", self.package).Mesh(single(mesh.vertices), mesh.faces.astype(np.int32))
        made.build("medium")
        return made

    def shoot(self, built: Built, rays: Rays) -> Hits:
        told = built.intersect(single(rays[:, 0:3]), single(rays[:, 3:6]), tfar=_ends(rays))
        return hits(None, told.distances, rays)

    def any(self, mesh: Mesh, rays: Rays) -> NDArray[np.bool_] | None:
        told = self.build(mesh).occlusion(single(rays[:, 0:3]), single(rays[:, 3:6]), tfar=_ends(rays))
        return np.asarray(told, dtype=bool)


def _ends(rays: Rays) -> NDArray[np.float32]:
    return single(np.minimum(rays[:, 7], float(np.finfo(np.float32).max)))
