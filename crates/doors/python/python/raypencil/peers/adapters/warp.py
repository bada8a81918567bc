"""NVIDIA Warp, on the processor and on a graphics card."""

from __future__ import annotations

import functools
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..._mesh import Mesh
from .._peer import Built, Hits, Peer, Rays, hits, need, single
from ._card import card

_ANY = "mesh_query_ray_anyhit"


@functools.cache
def _kernel() -> Any:
    wp = need("warp", "warp-lang")
    wp.config.quiet = True
    return need("raypencil.peers.adapters._warp_kernel", "warp-lang").first


class Warp(Peer):
    """`wp.mesh_query_ray`, in a kernel of one query."""

    name, title, package = "warp", "Warp, processor", "warp-lang"
    arithmetic = mesh_type = rays_type = "f32"
    causes = (
        "Its test of triangles is watertight; that of boxes (`intersect_ray_aabb`, warp/native/intersect.h) has no margin for its rounding,"
        " and at a vertex it may drop the face that the other would meet.",
    )
    place = "cpu"

    def build(self, mesh: Mesh) -> Built:
        kernel, wp = _kernel(), need("warp", self.package)
        points = wp.array(single(mesh.vertices), dtype=wp.vec3, device=self.place)
        corners = wp.array(mesh.faces.astype(np.int32).ravel(), dtype=wp.int32, device=self.place)
        return wp, kernel, wp.Mesh(points=points, indices=corners)

    def shoot(self, built: Built, rays: Rays) -> Hits:
        wp, kernel, mesh = built
        # An infinite end makes it answer nothing, so the largest number stands for it.
        ends = np.minimum(rays[:, 7], float(np.finfo(np.float32).max))
        given = [wp.array(single(rays[:, a:b]), dtype=wp.vec3, device=self.place) for a, b in ((0, 3), (3, 6))]
        far = wp.array(single(ends), dtype=wp.float32, device=self.place)
        face = wp.full(len(rays), -1, dtype=wp.int32, device=self.place)
        t = wp.zeros(len(rays), dtype=wp.float32, device=self.place)
        wp.launch(kernel, dim=len(rays), inputs=[mesh.id, *given, far, face, t], device=self.place)
        return hits(face.numpy(), t.numpy(), rays)

    def any(self, mesh: Mesh, rays: Rays) -> NDArray[np.bool_] | None:
        wp, _, made = self.build(mesh)
        if not hasattr(wp, "_src") or _ANY not in wp._src.context.builtin_functions:
            # Older ones have no such call.
            return None
        given = [wp.array(single(rays[:, a:b]), dtype=wp.vec3, device=self.place) for a, b in ((0, 3), (3, 6))]
        far = wp.array(single(np.minimum(rays[:, 7], float(np.finfo(np.float32).max))), dtype=wp.float32, device=self.place)
        is_hit = wp.zeros(len(rays), dtype=wp.int32, device=self.place)
        kernel = need("raypencil.peers.adapters._warp_any_kernel", self.package).any_hit
        wp.launch(kernel, dim=len(rays), inputs=[made.id, *given, far, is_hit], device=self.place)
        return np.asarray(is_hit.numpy() != 0)


class WarpCuda(Warp):
    """The same kernel on a graphics card. The time of a call includes the way of the rays to the card and of the hits back."""

    name, title = "warp-cuda", "Warp, graphics card"
    place = "cuda:0"

    def device(self) -> str:
        return card()
