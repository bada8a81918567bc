"""OpenUSD's GfRay."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

import numpy as np

from ..._mesh import Mesh
from .._peer import Built, Hits, Peer, Rays, hits, need


_LONGER = "make directions 1e6 long, and scale t: the product grows with them"


class Usd(Peer):
    """`GfRay.Intersect(p0, p1, p2)` on every face: OpenUSD has no tree."""

    name, title, package = "usd", "OpenUSD, GfRay", "usd-core"
    arithmetic = mesh_type = rays_type = "f64"
    is_brute_force = True
    causes = (
        "`GfRay::Intersect` (pxr/base/gf/ray.cpp) takes normal times direction below 1e-10 (`GF_MIN_VECTOR_LENGTH`) for 0, and the normal"
        " of a face with less than half of that for area is not made 1 long: the face's plane is then elsewhere.",
    )
    advice = ("scale a mesh with faces smaller than 5e-11, with its rays, and t back",)
    remedies: ClassVar[Mapping[tuple[str, str], str]] = {("angle", "below"): _LONGER, ("length", "below"): _LONGER}

    def build(self, mesh: Mesh) -> Built:
        gf = need("pxr.Gf", self.package)
        corners = [gf.Vec3d(*corner) for corner in mesh.vertices.tolist()]
        return gf, [[corners[i] for i in face] for face in mesh.faces.tolist()]

    def shoot(self, built: Built, rays: Rays) -> Hits:
        gf, faces = built
        face, t = np.full(len(rays), -1), np.full(len(rays), np.inf)
        for k, row in enumerate(rays.tolist()):
            ray = gf.Ray(gf.Vec3d(*row[0:3]), gf.Vec3d(*row[3:6]))
            for number, corners in enumerate(faces):
                is_hit, at, _, _ = ray.Intersect(*corners)
                if is_hit and 0 <= at < t[k]:
                    face[k], t[k] = number, at
        return hits(face, t, rays)
