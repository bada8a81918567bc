"""All peers, in the order of the page."""

from __future__ import annotations

from . import _ours
from ._peer import Peer, unknown
from .adapters import (
    cgal,
    embree,
    fcpw,
    libigl,
    meshlib,
    mitsuba,
    mujoco,
    ncollpyde,
    node,
    open3d,
    panda3d,
    pcu,
    pybullet,
    pyraymesh,
    raylib,
    raysect,
    rust,
    trimesh,
    usd,
    vtk,
    warp,
)

_CLASSES: tuple[type[Peer], ...] = (
    embree.Embree,
    embree.EmbreeRobust,
    open3d.Open3D,
    mitsuba.MitsubaScalar,
    mitsuba.MitsubaLlvm,
    mitsuba.MitsubaCuda,
    pcu.PointCloudUtils,
    libigl.LibiglEmbree,
    trimesh.TrimeshEmbree,
    trimesh.Trimesh,
    libigl.LibiglTree,
    libigl.LibiglBruteForce,
    vtk.VtkObbTree,
    vtk.VtkObbTreeAll,
    vtk.VtkCellLocator,
    vtk.VtkStaticCellLocator,
    vtk.VtkTolerance,
    vtk.VtkBspTree,
    vtk.VtkCellTree,
    warp.Warp,
    warp.WarpCuda,
    fcpw.Fcpw,
    meshlib.MeshLib,
    meshlib.MeshLibDouble,
    cgal.Cgal,
    ncollpyde.Ncollpyde,
    rust.Parry,
    rust.ParryDouble,
    node.Rapier,
    pyraymesh.PyRayMesh,
    rust.Bvh,
    rust.BvhDouble,
    rust.Obvhs,
    rust.ObvhsWide,
    rust.TinyBvh,
    rust.TinyBvhDouble,
    mujoco.MuJoCo,
    pybullet.PyBullet,
    node.Jolt,
    node.CannonEs,
    node.Three,
    node.ThreeMeshBvh,
    node.Babylon,
    panda3d.Panda3D,
    raylib.Raylib,
    raysect.Raysect,
    usd.Usd,
    _ours.Tracer,
    _ours.Referee,
)

#: What was looked for and is not asked, and why.
LEFT_OUT = {
    "Blender (bpy, mathutils)": "bpy wants NumPy 1, and the other packages want NumPy 2; mathutils does not build",
    "bvh-arena, rtbvh (crates.io)": "they have no test of triangles: whoever calls them brings one",
    "COMPAS CGAL": "the call that shoots rays, `pull_points_on_mesh`, moves points: it tells no faces and no misses",
    "embree (PyPI)": "it has no package for this Python",
    "embree4-rs (crates.io)": "it names no licence",
    "Mitsuba in double precision": "its packages do not have it",
    "nanort": "no registry has it: pip, npm, crates.io and Debian's packages were looked at",
    "pyembree": "it wants NumPy 1, and the other packages want NumPy 2",
    "PyMeshLab": "it has no call for rays",
    "pyoctree": "its package does not build",
    "PyVista": "`ray_trace` is VTK's OBB tree (the row *as PyVista asks it*), and `multi_ray_trace` trimesh with Embree: both are asked",
    "ray-triangle-intersection (npm)": "it is a test of triangles alone, and lets rays pass through backs",
}


def every_peer() -> list[Peer]:
    """All peers, whether installed or not; raypencil's own are the last."""
    return [one() for one in _CLASSES]


def peer(name: str) -> Peer:
    """A peer by its name.

    Args:
        name: as `raypencil-peers list` has it.

    Raises:
        RaypencilError: there is none of this name; the message lists them.
    """
    known = {one.name: one for one in _CLASSES}
    if name not in known:
        raise unknown(name, list(known))
    return known[name]()
