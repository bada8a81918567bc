"""Programs in JavaScript, each asked by a small script that Node runs: `npm install` in a folder that NODE_FOLDER names."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import ClassVar

import numpy as np

from ..._errors import RaypencilError
from ..._mesh import Mesh
from .._peer import Built, Hits, Peer, Rays, Unavailable, hits, segment_length

#: The variable of the environment that names the folder with `node_modules`; without it, the folder one is in.
NODE_FOLDER = "RAYPENCIL_PEERS_NODE"

_SCRIPTS = Path(__file__).parent / "scripts"


def _message(text: str) -> str:
    """The error in what Node writes: without the line of source, which may be a whole program, and the stack."""
    lines = [line for line in text.splitlines() if re.match(r"\w*Error\b", line)]
    return lines[0].strip() if lines else text.strip()[-200:]


class NodePeer(Peer):
    """A script reads the question as raw numbers, and writes faces and ts."""

    registry = "npm"
    script: ClassVar[str]

    def folder(self) -> Path:
        """The folder of its package.

        Raises:
            Unavailable: there is no Node, or not this package.
        """
        if shutil.which("node") is None:
            raise Unavailable("there is no `node`, which runs packages of npm")
        found = Path(os.environ.get(NODE_FOLDER, ".")).resolve() / "node_modules" / self.package
        if not found.is_dir():
            raise Unavailable(f"{self.package} is not in {found.parent}: npm install {self.package}, and {NODE_FOLDER}=its folder")
        return found

    def version(self) -> str:
        return str(json.loads((self.folder() / "package.json").read_text(encoding="utf-8"))["version"])

    def build(self, mesh: Mesh) -> Built:
        self.folder()
        return mesh

    def timed(self, built: Built, rays: Rays) -> tuple[Hits, float]:
        mesh: Mesh = built
        length = segment_length(mesh.vertices, rays) if self.is_segment else np.ones(len(rays))
        with tempfile.TemporaryDirectory() as kept:
            folder = Path(kept)
            mesh.vertices.astype("<f8").tofile(folder / "vertices")
            mesh.faces.astype("<u4").tofile(folder / "faces")
            given = np.array(rays[:, 0:8])
            given[:, 3:6] *= length[:, None]
            given.astype("<f8").tofile(folder / "rays")
            root = self.folder().parents[len(Path(self.package).parts) - 1].parent
            words = ["node", str(_SCRIPTS / self.script), str(root), str(folder)]
            done = subprocess.run(words, capture_output=True, text=True, timeout=600)
            if done.returncode != 0:
                raise RaypencilError(f"{self.name}: {_message(done.stderr)}")
            t = np.fromfile(folder / "t", dtype="<f8") * length
            face = np.fromfile(folder / "face", dtype="<i4") if (folder / "face").is_file() else None
            return hits(face, t, rays), float(done.stdout.split()[-1]) / 1000

    def shoot(self, built: Built, rays: Rays) -> Hits:
        return self.timed(built, rays)[0]


class Three(NodePeer):
    """`Raycaster.intersectObject` on a mesh that is drawn from both sides."""

    name, title, package, script = "three", "three.js", "three", "three.mjs"
    conventions = ("Positions are a `Float32Array`, as for what is drawn; of a `Float64Array` it takes double precision.",)
    arithmetic = rays_type = "f64"
    mesh_type = "f32"
    is_unit = True


class ThreeMeshBvh(NodePeer):
    """`MeshBVH.raycastFirst`, with the option that keeps the order of the faces."""

    name, title, package, script = "three-mesh-bvh", "three-mesh-bvh", "three-mesh-bvh", "three_mesh_bvh.mjs"
    conventions = ("It sorts the index and numbers faces anew, unless it is told `indirect: true`, as here.",)
    arithmetic = rays_type = "f64"
    mesh_type = "f32"
    is_unit = True


class Babylon(NodePeer):
    """`Mesh.intersects`, with an engine that draws nothing."""

    name, title, package, script = "babylon", "Babylon.js", "@babylonjs/core", "babylon.mjs"
    arithmetic = rays_type = "f64"
    mesh_type = "f32"
    # Its distance is a length, whatever the direction's is.
    is_unit = True
    causes = (
        "Its test of the mesh's box takes a part of the direction below 1e-07 for 0 (`Ray.intersectsBoxMinMax`, Culling/ray.core.js): it is"
        " the box that is missed, and the faces are not asked.",
    )
    remedies: ClassVar[Mapping[tuple[str, str], str]] = {
        ("angle", "below"): "leave out the test of the box: the last argument of `Mesh.intersects`, `skipBoundingInfo`, is then true",
    }


class Rapier(NodePeer):
    """`Collider.castRayAndGetNormal` of a `TriMesh`, which is parry's in single precision. It tells the side of a face, not which it is."""

    name, title, package, script = "rapier", "Rapier (parry)", "@dimforge/rapier3d-compat", "rapier.mjs"
    conventions = ("`featureId` is the side of the face, not its number; so t alone is judged. parry itself tells the face.",)
    arithmetic = mesh_type = rays_type = "f32"


class CannonEs(NodePeer):
    """`World.raycastClosest` on a `Trimesh`. Its face is not that of the nearest hit, so none is told."""

    name, title, package, script = "cannon-es", "cannon-es", "cannon-es", "cannon_es.mjs"
    conventions = ("`hitFaceIndex` is that of the last face that was met, not of the nearest; so t alone is judged.",)
    causes = (
        "`Ray.pointInTriangle` (dist/cannon-es.js) asks of the rounded point on the plane whether it is inside, without a tolerance: beside an"
        " edge it may be in neither face.",
    )
    # It keeps the faces' normals in single precision.
    arithmetic = mesh_type = "f32"
    rays_type = "f64"
    is_segment = True


class Jolt(NodePeer):
    """`NarrowPhaseQuery.CastRay` on a body of a `MeshShape`, whose faces keep their numbers as user data."""

    name, title, package, script = "jolt", "Jolt Physics", "jolt-physics", "jolt.mjs"
    conventions = (
        "It numbers faces anew; theirs are kept as user data (`mPerTriangleUserData`), as here.",
        "It keeps corners in 21 bits of the mesh's box, which is within what rounding excuses"
        " (`TriangleCodecIndexed8BitPackSOA4Flags.h`).",
    )
    causes = (
        "It drops faces with a cross product of edges at most 1e-06 long (`IndexedTriangleNoMaterial::IsDegenerate`,"
        " Jolt/Geometry/IndexedTriangle.h), and refuses a mesh that has no others.",
    )
    advice = ("scale a mesh with small faces, with its rays, and t back", "do not count crossings of closed meshes by it")
    arithmetic = mesh_type = rays_type = "f32"
    is_segment = True
