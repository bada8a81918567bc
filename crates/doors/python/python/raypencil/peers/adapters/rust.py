"""Ray tracers of Rust, each asked by one small program that is built from `reference/peers/rust`."""

from __future__ import annotations

import functools
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import ClassVar

import numpy as np

from ..._errors import RaypencilError
from ..._mesh import Mesh
from .._peer import Built, Hits, Peer, Rays, Unavailable, hits

#: The variable of the environment that names the program; without it, one beside Python or on the path.
RUST_PROGRAM = "RAYPENCIL_PEERS_RUST"

_NAME = "raypencil-peers-rust"

#: How it is got, for messages.
_HOW = f"cargo install --path reference/peers/rust --root ENV in a clone of raypencil, and {RUST_PROGRAM}=ENV/bin/{_NAME}"


def _program() -> str:
    if named := os.environ.get(RUST_PROGRAM):
        found = shutil.which(named)
    else:
        found = shutil.which(_NAME, path=str(Path(sys.executable).parent)) or shutil.which(_NAME)
    if found is None:
        raise Unavailable(f"there is no program `{named or _NAME}`: {_HOW}")
    return found


@functools.cache
def _versions(program: str) -> dict[str, str]:
    """The versions of the crates that a program was built with, by the names of the peers."""
    done = subprocess.run([program, "versions"], capture_output=True, text=True, timeout=60)
    if done.returncode != 0:
        raise Unavailable(f"`{program} versions` does not answer ({done.stderr.strip()}): {_HOW}")
    return dict(line.split() for line in done.stdout.splitlines())


class RustPeer(Peer):
    """The program reads the question as raw numbers, and writes faces and ts."""

    registry = "crates.io"

    def version(self) -> str:
        program = _program()
        try:
            return _versions(program)[self.name]
        except KeyError:
            raise Unavailable(f"`{program}` does not know {self.name}: {_HOW}") from None

    def build(self, mesh: Mesh) -> Built:
        return _program(), mesh

    def timed(self, built: Built, rays: Rays) -> tuple[Hits, float]:
        program, mesh = built
        with tempfile.TemporaryDirectory() as kept:
            folder = Path(kept)
            mesh.vertices.astype("<f8").tofile(folder / "vertices")
            mesh.faces.astype("<u4").tofile(folder / "faces")
            np.asarray(rays[:, 0:8]).astype("<f8").tofile(folder / "rays")
            done = subprocess.run([program, self.name, str(folder)], capture_output=True, text=True, timeout=600)
            if done.returncode != 0:
                raise RaypencilError(f"{self.name}: {(done.stderr.strip().splitlines() or ['it ended without a word'])[-1]}")
            face, t = np.fromfile(folder / "face", dtype="<i4"), np.fromfile(folder / "t", dtype="<f8")
            return hits(face, t, rays), float(done.stdout) / 1000

    def shoot(self, built: Built, rays: Rays) -> Hits:
        return self.timed(built, rays)[0]


class Parry(RustPeer):
    """`TriMesh::cast_local_ray_and_get_normal`, whose `subshape` is the face."""

    name, title, package = "parry", "parry", "parry3d"
    arithmetic = mesh_type = rays_type = "f32"


class ParryDouble(RustPeer):
    """The same in double precision."""

    name, title, package = "parry-f64", "parry, double", "parry3d-f64"
    arithmetic = mesh_type = rays_type = "f64"


_BOTH_SIDES = "Its test of triangles leaves out backs; both windings of each face are asked here."
_EPSILON = (
    "`Ray::intersects_triangle` (src/ray/ray_impl.rs) takes a determinant below the type's epsilon, {}, for 0, and a hit nearer than that"
    " for none."
)


class Bvh(RustPeer):
    """`Bvh::traverse_iterator`, and `Ray::intersects_triangle` on each face that it finds."""

    name, title, package = "bvh", "bvh (Rust)", "bvh"
    arithmetic = mesh_type = rays_type = "f32"
    is_unit = True
    conventions = (_BOTH_SIDES,)
    causes = (_EPSILON.format("1.2e-07"),)


class BvhDouble(RustPeer):
    """The same in double precision."""

    name, title, package = "bvh-f64", "bvh (Rust), double", "bvh"
    arithmetic = mesh_type = rays_type = "f64"
    is_unit = True
    conventions = (_BOTH_SIDES,)
    causes = (_EPSILON.format("2.2e-16"),)


class Obvhs(RustPeer):
    """`Bvh2::ray_traverse` with `Triangle::intersect`, as its example `basic_bvh2` has it."""

    name, title, package = "obvhs", "obvhs, two children", "obvhs"
    causes: ClassVar[tuple[str, ...]] = ("`safe_inverse` (src/ray.rs), for its test of boxes, takes a part of the direction below 1.2e-07 for that.",)
    arithmetic = mesh_type = rays_type = "f32"


#: Directions 1 long are too long for a small mesh: see the causes.
_AS_LONG = "make directions as long as the way to the mesh, and scale t"


class ObvhsWide(Obvhs):
    """`CwBvh::ray_traverse` with `Triangle::intersect`, as its example `basic_cwbvh` has it."""

    name, title = "obvhs-cwbvh", "obvhs, eight children"
    causes = (
        *Obvhs.causes,
        "`intersect_ray_simd` (src/cwbvh/simd.rs) asks no box that ends before t = 1e-04 (`EPSILON`).",
    )
    remedies: ClassVar[Mapping[tuple[str, str], str]] = {("length", "below"): _AS_LONG, ("length", "above"): _AS_LONG}
    conventions = (
        "Parts of the direction that are -0 are asked as 0: with -0 it misses every box, since `safe_inverse` (src/ray.rs) goes by the sign"
        " and `intersect_ray_simd` (src/cwbvh/simd.rs) by `<`.",
    )


_HEADER = (
    "It makes directions 1 long by itself. Its header is the one in the crate tinybvh-rs 0.1.0-beta.3, whose own wrapper is not asked: it"
    " crashes, for its rays are smaller than the header's."
)


class TinyBvh(RustPeer):
    """tinybvh's `BVH::Intersect`."""

    name, title, package = "tinybvh", "tinybvh", "tinybvh"
    arithmetic = mesh_type = rays_type = "f32"
    is_unit = True
    conventions = (_HEADER,)
    causes = (
        "Its test of triangles takes a determinant below 1e-06 for 0 (`MOLLER_TRUMBORE_TEST`, tiny_bvh.h), and a hit farther than 1e30 is none"
        " (`BVH_FAR`).",
    )


class TinyBvhDouble(RustPeer):
    """tinybvh's `BVH_Double::Intersect`."""

    name, title, package = "tinybvh-double", "tinybvh, double", "tinybvh"
    arithmetic = mesh_type = rays_type = "f64"
    is_unit = True
    conventions = (_HEADER,)
    causes = ("Its test of triangles takes a determinant below 1e-07 for 0 (`BVH_Double::Intersect`, tiny_bvh.h).",)
