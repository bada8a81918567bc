"""MeshLib."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np

from ..._judge import Arithmetic
from ..._mesh import Mesh
from .._peer import Built, Hits, Peer, Rays, hits, need


class MeshLib(Peer):
    """`rayMeshIntersect` in single precision."""

    name, title, package = "meshlib", "MeshLib, float", "meshlib"
    arithmetic: ClassVar[Arithmetic] = "f32"
    rays_type: ClassVar[Arithmetic] = "f32"
    mesh_type = "f32"
    kind = "f"

    def build(self, mesh: Mesh) -> Built:
        mr, numpy = need("meshlib.mrmeshpy", self.package), need("meshlib.mrmeshnumpy", self.package)
        made = numpy.meshFromFacesVerts(mesh.faces.astype(np.int32), np.array(mesh.vertices))
        return mr, mr.MeshPart(made), made

    def shoot(self, built: Built, rays: Rays) -> Hits:
        mr, part, _ = built
        line, vector = getattr(mr, f"Line3{self.kind}"), getattr(mr, f"Vector3{self.kind}")
        face, t = np.full(len(rays), -1), np.full(len(rays), np.inf)
        for k, ray in enumerate(rays.tolist()):
            found = mr.rayMeshIntersect(part, line(vector(*ray[0:3]), vector(*ray[3:6])))
            if found.proj.face.valid():
                face[k], t[k] = found.proj.face.get(), found.distanceAlongLine
        return hits(face, t, rays)

    def all(self, mesh: Mesh, rays: Rays) -> list[list[tuple[int, float]]] | None:
        mr, part, _ = self.build(mesh)
        line, vector = getattr(mr, f"Line3{self.kind}"), getattr(mr, f"Vector3{self.kind}")
        told = []
        for ray in rays.tolist():
            found: list[tuple[int, float]] = []

            def meet(hit: Any, found: list[tuple[int, float]] = found) -> bool:
                found.append((hit.proj.face.get(), hit.distanceAlongLine))
                return True

            mr.rayMeshIntersectAll(part, line(vector(*ray[0:3]), vector(*ray[3:6])), mr.func_bool_from_MeshIntersectionResult(meet))
            told.append(sorted(found, key=lambda hit: hit[1]))
        return told


class MeshLibDouble(MeshLib):
    """The same with a line in double precision; the mesh stays in single."""

    name, title, kind = "meshlib-double", "MeshLib, double", "d"
    arithmetic = "f64"
    rays_type = "f64"
    conventions = ("It tells t in single precision, whatever it computes in.",)
