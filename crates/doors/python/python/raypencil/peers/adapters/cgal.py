"""CGAL, by its SWIG bindings."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from ..._mesh import Mesh
from .._peer import Built, Hits, Peer, Rays, hits, need


_AS_LONG = "make the direction as long as the way to the mesh, and scale t: the second point is then kept well"


class Cgal(Peer):
    """`AABB_tree_Triangle_3_soup`, in CGAL's kernel of exact predicates and inexact constructions.

    Which faces a ray meets is decided exactly; their points are rounded, and this adapter takes the nearest of them.
    """

    name, title, package = "cgal", "CGAL, AABB tree", "cgal"
    arithmetic = mesh_type = rays_type = "f64"
    meets_in_plane = True
    conventions = (
        "A ray that lies in a face's plane meets the face in a segment, whose near end is taken here.",
        "`Ray_3` keeps a second point, origin plus direction: what a direction has below the origin's last digit is lost.",
        "The exact set of faces is asked (`all_intersections`), for the bindings have no call for the first.",
    )
    remedies: ClassVar[Mapping[tuple[str, str], str]] = {("distance", "above"): _AS_LONG, ("length", "below"): _AS_LONG}

    def build(self, mesh: Mesh) -> Built:
        kernel, trees = need("CGAL.CGAL_Kernel", self.package), need("CGAL.CGAL_AABB_tree", self.package)
        points = [kernel.Point_3(*corner) for corner in mesh.vertices.tolist()]
        triangles = [kernel.Triangle_3(*(points[i] for i in face)) for face in mesh.faces.tolist()]
        # Its tree asks for faces with an area.
        numbers = [k for k, triangle in enumerate(triangles) if not triangle.is_degenerate()]
        tree = trees.AABB_tree_Triangle_3_soup([triangles[k] for k in numbers])
        return kernel, tree, numbers

    def all_of(self, built: Built, rays: Rays) -> list[list[tuple[int, float]]]:
        """All hits of each ray, in order of t."""
        kernel, tree, numbers = built
        told = []
        for ray in rays:
            start, way = kernel.Point_3(*ray[0:3].tolist()), kernel.Vector_3(*ray[3:6].tolist())
            axis = int(np.argmax(np.abs(ray[3:6])))
            found: list[object] = []
            tree.all_intersections(kernel.Ray_3(start, way), found)
            hits_of_ray = []
            for one in found:
                place, number = one.first, one.second  # type: ignore[attr-defined]
                if place.is_Point_3():
                    ends = [place.get_Point_3()]
                else:
                    segment = place.get_Segment_3()
                    ends = [segment.source(), segment.target()]
                t = min((getattr(end, "xyz"[axis])() - ray[axis]) / ray[3 + axis] for end in ends)
                hits_of_ray.append((float(t), numbers[number]))
            told.append([(face, t) for t, face in sorted(hits_of_ray)])
        return told

    def shoot(self, built: Built, rays: Rays) -> Hits:
        firsts = [(one[0] if one else (-1, np.inf)) for one in self.all_of(built, rays)]
        return hits([face for face, _ in firsts], [t for _, t in firsts], rays)

    def all(self, mesh: Mesh, rays: Rays) -> list[list[tuple[int, float]]] | None:
        return self.all_of(self.build(mesh), rays)

    def any(self, mesh: Mesh, rays: Rays) -> NDArray[np.bool_] | None:
        kernel, tree, _ = self.build(mesh)
        asked = (kernel.Ray_3(kernel.Point_3(*ray[0:3]), kernel.Vector_3(*ray[3:6])) for ray in rays.tolist())
        return np.array([tree.do_intersect(ray) for ray in asked], dtype=bool)
