"""Open3D's RaycastingScene."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..._mesh import Mesh
from .._peer import Built, Hits, Peer, Rays, hits, need, single
from .embree import SHORT_PARTS


class Open3D(Peer):
    """`RaycastingScene.cast_rays`, whose t is in lengths of the direction."""

    name, title, package = "open3d", "Open3D", "open3d"
    causes = (SHORT_PARTS,)
    conventions = ("It asks Embree with its flag for robust traversal (cpp/open3d/t/geometry/RaycastingScene.cpp).",)
    arithmetic = mesh_type = rays_type = "f32"

    def build(self, mesh: Mesh) -> Built:
        scene = need("open3d", self.package).t.geometry.RaycastingScene()
        scene.add_triangles(single(mesh.vertices), mesh.faces.astype(np.uint32))
        return scene

    def shoot(self, built: Built, rays: Rays) -> Hits:
        o3d = need("open3d", self.package)
        told = built.cast_rays(o3d.core.Tensor(single(rays[:, 0:6])))
        t = told["t_hit"].numpy()
        return hits(told["primitive_ids"].numpy().astype(np.int64), t, rays, is_hit=np.isfinite(t))

    def any(self, mesh: Mesh, rays: Rays) -> NDArray[np.bool_] | None:
        o3d = need("open3d", self.package)
        # It takes one end for all rays; those with an end of their own are asked one by one.
        scene, told = self.build(mesh), np.zeros(len(rays), dtype=bool)
        for end in np.unique(rays[:, 7]):
            some = rays[:, 7] == end
            asked = o3d.core.Tensor(single(rays[some, 0:6]))
            told[some] = scene.test_occlusions(asked, tnear=0.0, tfar=float(end)).numpy()
        return told

    def all(self, mesh: Mesh, rays: Rays) -> list[list[tuple[int, float]]] | None:
        o3d = need("open3d", self.package)
        told = self.build(mesh).list_intersections(o3d.core.Tensor(single(rays[:, 0:6])))
        faces, ts, ends = (told[name].numpy().tolist() for name in ("primitive_ids", "t_hit", "ray_splits"))
        parts = (slice(a, b) for a, b in zip(ends[:-1], ends[1:], strict=True))
        return [sorted(zip(faces[part], ts[part], strict=True), key=lambda hit: hit[1]) for part in parts]
