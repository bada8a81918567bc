"""NVIDIA Warp, on the processor."""

from __future__ import annotations

import functools
from typing import Any

import numpy as np

from ..._mesh import Mesh
from .._peer import Built, Hits, Peer, Rays, hits, need, single


@functools.cache
def _kernel() -> Any:
    wp = need("warp", "warp-lang")
    wp.config.quiet = True
    return need("raypencil.peers.adapters._warp_kernel", "warp-lang").first


class Warp(Peer):
    """`wp.mesh_query_ray`, in a kernel of one query."""

    name, title, package = "warp", "Warp, processor", "warp-lang"
    arithmetic = mesh_type = rays_type = "f32"
    device = "cpu"

    def build(self, mesh: Mesh) -> Built:
        kernel, wp = _kernel(), need("warp", self.package)
        points = wp.array(single(mesh.vertices), dtype=wp.vec3, device=self.device)
        corners = wp.array(mesh.faces.astype(np.int32).ravel(), dtype=wp.int32, device=self.device)
        return wp, kernel, wp.Mesh(points=points, indices=corners)

    def shoot(self, built: Built, rays: Rays) -> Hits:
        wp, kernel, mesh = built
        # An infinite end makes it answer nothing, so the largest number stands for it.
        ends = np.minimum(rays[:, 7], float(np.finfo(np.float32).max))
        given = [wp.array(single(rays[:, a:b]), dtype=wp.vec3, device=self.device) for a, b in ((0, 3), (3, 6))]
        far = wp.array(single(ends), dtype=wp.float32, device=self.device)
        face = wp.full(len(rays), -1, dtype=wp.int32, device=self.device)
        t = wp.zeros(len(rays), dtype=wp.float32, device=self.device)
        wp.launch(kernel, dim=len(rays), inputs=[mesh.id, *given, far, face, t], device=self.device)
        return hits(face.numpy(), t.numpy(), rays)
