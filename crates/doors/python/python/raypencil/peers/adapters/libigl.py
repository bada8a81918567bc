"""libigl: its tree of boxes, its test of every face, and its Embree."""

from __future__ import annotations

import numpy as np

from ..._mesh import Mesh
from .._peer import Built, Hits, Peer, Rays, hits, need, single
from .embree import SHORT_PARTS

_CAUSES = (
    "Its test of triangles takes a determinant below 1e-06 for 0, which is the product of two edges, the direction's length and the"
    " sine of the angle (`IGL_RAY_TRI_EPSILON`, include/igl/raytri.c).",
)
_SINGLE = (
    "It tells t in single precision, whatever it computes in, and orders hits by it: so on *nearly-coincident*, where the faces tie."
)
_LONGER = "make directions 1e12 long, and scale t: the determinant grows with them"
_REMEDIES = {
    ("scale", "below"): _LONGER,
    ("angle", "below"): _LONGER,
    ("aspect", "above"): _LONGER,
    ("length", "below"): _LONGER,
}


class LibiglTree(Peer):
    """`igl.AABB.intersect_ray_first`."""

    name, title, package = "libigl", "libigl, AABB", "libigl"
    conventions = (_SINGLE,)
    causes, remedies = _CAUSES, _REMEDIES
    arithmetic = mesh_type = rays_type = "f64"

    def build(self, mesh: Mesh) -> Built:
        igl = need("igl", self.package)
        vertices, faces = np.array(mesh.vertices), mesh.faces.astype(np.int64)
        tree = igl.AABB()
        tree.init(vertices, faces)
        return tree, vertices, faces

    def shoot(self, built: Built, rays: Rays) -> Hits:
        tree, vertices, faces = built
        face, t, _ = tree.intersect_ray_first(vertices, faces, rays[:, 0:3].copy(), rays[:, 3:6].copy())
        return hits(face, t, rays)

    def all(self, mesh: Mesh, rays: Rays) -> list[list[tuple[int, float]]] | None:
        tree, vertices, faces = self.build(mesh)
        found = tree.intersect_ray(vertices, faces, rays[:, 0:3].copy(), rays[:, 3:6].copy())
        return [sorted(((hit[0], hit[1]) for hit in one), key=lambda hit: hit[1]) for one in found]


class LibiglBruteForce(Peer):
    """`igl.ray_mesh_intersect`, which tries every face."""

    name, title, package = "libigl-brute", "libigl, every face", "libigl"
    conventions = (
        _SINGLE,
        "`ray_mesh_intersect(..., first=True)` tells a hit of unwritten memory where there is none; so all hits are asked.",
    )
    causes, remedies = _CAUSES, _REMEDIES
    arithmetic = mesh_type = rays_type = "f64"
    is_brute_force = True

    def build(self, mesh: Mesh) -> Built:
        return need("igl", self.package), np.array(mesh.vertices), mesh.faces.astype(np.int64)

    def shoot(self, built: Built, rays: Rays) -> Hits:
        igl, vertices, faces = built
        face, t = np.full(len(rays), -1), np.full(len(rays), np.inf)
        for k, ray in enumerate(rays):
            # With `first=True` it tells a hit of memory that nobody wrote where there is none.
            if found := igl.ray_mesh_intersect(ray[0:3].copy(), ray[3:6].copy(), vertices, faces):
                face[k], t[k] = found[0][0:2]
        return hits(face, t, rays)

    def all(self, mesh: Mesh, rays: Rays) -> list[list[tuple[int, float]]] | None:
        igl, vertices, faces = self.build(mesh)
        found = (igl.ray_mesh_intersect(ray[0:3].copy(), ray[3:6].copy(), vertices, faces) or [] for ray in rays)
        return [[(hit[0], hit[1]) for hit in one] for one in found]


class LibiglEmbree(Peer):
    """`igl.embree.EmbreeIntersector`."""

    name, title, package = "libigl-embree", "libigl, Embree", "libigl"
    causes = (SHORT_PARTS,)
    arithmetic = mesh_type = rays_type = "f32"

    def build(self, mesh: Mesh) -> Built:
        one = need("igl.embree", self.package).EmbreeIntersector()
        vertices, faces = np.asfortranarray(single(mesh.vertices)), np.asfortranarray(mesh.faces.astype(np.int32))
        one.init(vertices, faces)
        return one

    def shoot(self, built: Built, rays: Rays) -> Hits:
        face, t = np.full(len(rays), -1), np.full(len(rays), np.inf)
        for k, ray in enumerate(rays.astype(np.float32)):
            face[k], t[k], _, _ = built.intersectRay_first(ray[0:3].copy(), ray[3:6].copy())
        return hits(face, t, rays)

    def all(self, mesh: Mesh, rays: Rays) -> list[list[tuple[int, float]]] | None:
        built = self.build(mesh)
        found = (built.intersectRay(ray[0:3].copy(), ray[3:6].copy())[0] for ray in rays.astype(np.float32))
        return [[(hit[0], hit[1]) for hit in one] for one in found]
