"""Panda3D."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

import numpy as np

from ..._mesh import Mesh
from .._peer import Built, Hits, Peer, Rays, hits, need


_AS_LONG = "make directions about as long as the way to the mesh, and scale t"


class Panda3D(Peer):
    """`CollisionRay` on a `CollisionPolygon` for each face. Its packages have single precision."""

    name, title, package = "panda3d", "Panda3D", "panda3d"
    causes = (
        "`LPlane::intersects_line` (panda/src/mathutil/plane_src.I) takes unit normal times direction below 1e-06 for 0.",
        "`CollisionRay::compute_internal_bounds` (panda/src/collide/collisionRay.cxx) keeps a second point, origin plus direction: what a"
        " direction has below the origin's last digit is lost.",
    )
    remedies: ClassVar[Mapping[tuple[str, str], str]] = {
        ("scale", "above"): _AS_LONG,
        ("length", "below"): _AS_LONG,
        ("length", "above"): _AS_LONG,
    }
    arithmetic = mesh_type = rays_type = "f32"
    is_brute_force = True

    def build(self, mesh: Mesh) -> Built:
        core = need("panda3d.core", self.package)
        root = core.NodePath("root")
        corners = [core.Point3(*corner) for corner in mesh.vertices.tolist()]
        for number, face in enumerate(mesh.faces.tolist()):
            # It refuses faces without an area by an assertion.
            if core.CollisionPolygon.verify_points(*(corners[i] for i in face)):
                node = core.CollisionNode(str(number))
                node.add_solid(core.CollisionPolygon(*(corners[i] for i in face)))
                root.attach_new_node(node)
        shooter, ray = core.CollisionNode("ray"), core.CollisionRay()
        shooter.add_solid(ray)
        traverser, queue = core.CollisionTraverser(), core.CollisionHandlerQueue()
        traverser.add_collider(root.attach_new_node(shooter), queue)
        return core, root, ray, traverser, queue

    def shoot(self, built: Built, rays: Rays) -> Hits:
        core, root, ray, traverser, queue = built
        face, t = np.full(len(rays), -1), np.full(len(rays), np.inf)
        for k, row in enumerate(rays):
            ray.set_origin(*row[0:3].tolist())
            ray.set_direction(*row[3:6].tolist())
            traverser.traverse(root)
            axis = int(np.argmax(np.abs(row[3:6])))
            for one in queue.entries:
                if one.has_surface_point():
                    at = (one.get_surface_point(root)[axis] - row[axis]) / row[3 + axis]
                    if at < t[k]:
                        face[k], t[k] = int(one.get_into_node().name), at
        return hits(face, t, rays)
