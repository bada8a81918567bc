"""Embree, by its bindings embreex."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ..._mesh import Mesh
from .._peer import Built, Hits, Peer, Rays, hits, need, single


#: The cause of Embree's threshold, wherever Embree is asked. A face alone, which has no box above it, is met by any direction.
SHORT_PARTS = (
    "Embree's test of boxes takes a part of the direction below 1e-18, of either sign, for +1e-18 (`zero_fix`, common/math/vec3fa.h;"
    " `min_rcp_input`, common/math/constants.h)."
)


class Embree(Peer):
    """Embree as trimesh and others build its scenes: without its flag for robust traversal."""

    name, title, package = "embree", "Embree", "embreex"
    causes: ClassVar[tuple[str, ...]] = (SHORT_PARTS,)
    conventions: ClassVar[tuple[str, ...]] = ("One ray is asked at a time: the bindings have no packets.",)
    advice: ClassVar[tuple[str, ...]] = (
        "turn robust on (`RTC_SCENE_FLAG_ROBUST`; of embreex `EmbreeScene(robust=True)`): then none of *tiny* and *huge* is lost, and far"
        " fewer rays through edges and vertices of other people's meshes ([peers-hunts.md](peers-hunts.md))",
    )
    arithmetic = mesh_type = rays_type = "f32"
    is_robust = False

    def build(self, mesh: Mesh) -> Built:
        scenes = need("embreex.rtcore_scene", self.package)
        meshes = need("embreex.mesh_construction", self.package)
        scene = scenes.EmbreeScene(robust=self.is_robust)
        # The scene keeps no reference to the mesh.
        kept = meshes.TriangleMesh(scene, single(mesh.vertices), mesh.faces.astype(np.int32))
        return scene, kept

    def shoot(self, built: Built, rays: Rays) -> Hits:
        told: dict[str, Any] = built[0].run(single(rays[:, 0:3]), single(rays[:, 3:6]), dists=single(rays[:, 7]), output=1)
        return hits(told["primID"].astype(np.int32), told["tfar"], rays)

    def any(self, mesh: Mesh, rays: Rays) -> NDArray[np.bool_] | None:
        built = self.build(mesh)
        told = built[0].run(single(rays[:, 0:3]), single(rays[:, 3:6]), dists=single(rays[:, 7]), query="OCCLUDED")
        # An occluded ray has 0, another one -1.
        return np.asarray(np.asarray(told) != -1)


class EmbreeRobust(Embree):
    """Embree with RTC_SCENE_FLAG_ROBUST."""

    name, title = "embree-robust", "Embree, robust"
    advice = ()
    is_robust = True
