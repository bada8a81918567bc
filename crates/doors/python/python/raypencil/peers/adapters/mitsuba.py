"""Mitsuba 3, in its variants. Its packages have single precision."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ..._mesh import Mesh
from .._peer import Built, Hits, Peer, Rays, hits, need, single
from ._card import card
from .embree import SHORT_PARTS


class MitsubaScalar(Peer):
    """`scene.ray_intersect_preliminary`, one ray at a time."""

    name, title, package = "mitsuba-scalar", "Mitsuba, scalar_rgb", "mitsuba"
    causes: ClassVar[tuple[str, ...]] = (
        SHORT_PARTS,
        "Its Embree is built to leave out rays with a part of origin or direction beyond 1.844e18 (`EMBREE_IGNORE_INVALID_RAYS`,"
        " ext/CMakeLists.txt; `FLT_LARGE`, Embree's common/math/constants.h).",
    )
    advice: ClassVar[tuple[str, ...]] = (
        "turn robust on (`embree_use_robust_intersections` of the scene): then none of *tiny* and *huge* is lost",
    )
    arithmetic = mesh_type = rays_type = "f32"
    variant = "scalar_rgb"

    def build(self, mesh: Mesh) -> Built:
        mi = need("mitsuba", self.package)
        mi.set_variant(self.variant)
        made = mi.Mesh("mesh", len(mesh.vertices), len(mesh.faces))
        parameters = mi.traverse(made)
        parameters["vertex_positions"] = np.ravel(single(mesh.vertices))
        parameters["faces"] = np.ravel(mesh.faces.astype(np.uint32))
        parameters.update()
        return mi, mi.load_dict({"type": "scene", "mesh": made})

    def asked(self, mi: Any, rays: Rays) -> list[Any]:
        """The rays as Mitsuba has them: one for each."""
        given = single(rays).tolist()
        return [mi.Ray3f(o=row[:3], d=row[3:6], maxt=row[7], time=0.0, wavelengths=[]) for row in given]

    def shoot(self, built: Built, rays: Rays) -> Hits:
        mi, scene = built
        face, t = np.full(len(rays), -1), np.full(len(rays), np.inf)
        for k, ray in enumerate(self.asked(mi, rays)):
            found = scene.ray_intersect_preliminary(ray)
            if found.is_valid():
                face[k], t[k] = found.prim_index, found.t
        return hits(face, t, rays)

    def any(self, mesh: Mesh, rays: Rays) -> NDArray[np.bool_] | None:
        mi, scene = self.build(mesh)
        return np.array([bool(scene.ray_test(ray)) for ray in self.asked(mi, rays)])


class MitsubaLlvm(MitsubaScalar):
    """The same, on arrays of rays."""

    name, title, variant = "mitsuba-llvm", "Mitsuba, llvm_ad_rgb", "llvm_ad_rgb"

    def asked(self, mi: Any, rays: Rays) -> list[Any]:
        """The rays as Mitsuba has them: all in one."""
        parts = [single(rays[:, k]) for k in (0, 1, 2, 3, 4, 5, 7)]
        many = mi.Ray3f(o=mi.Point3f(*parts[:3]), d=mi.Vector3f(*parts[3:6]))
        many.maxt = mi.Float(parts[6])
        return [many]

    def shoot(self, built: Built, rays: Rays) -> Hits:
        mi, scene = built
        (many,) = self.asked(mi, rays)
        found = scene.ray_intersect_preliminary(many, coherent=False)
        return hits(np.array(found.prim_index), np.array(found.t), rays, is_hit=np.array(found.is_valid()))

    def any(self, mesh: Mesh, rays: Rays) -> NDArray[np.bool_] | None:
        mi, scene = self.build(mesh)
        (many,) = self.asked(mi, rays)
        return np.array(scene.ray_test(many), dtype=bool)


class MitsubaCuda(MitsubaLlvm):
    """The same on a graphics card, where OptiX finds the hits. All but a card's driver comes with the package."""

    name, title, variant = "mitsuba-cuda", "Mitsuba, cuda_ad_rgb", "cuda_ad_rgb"
    causes = ()
    advice = ()

    def device(self) -> str:
        return card()
