"""A million rays on a mesh: exact by raypencil, in single precision by Open3D.

    million.py MESH.glb      (pip install raypencil open3d)
"""

import sys
import time

import numpy as np
import open3d as o3d
import raypencil

mesh = raypencil.load_mesh(sys.argv[1])
low, high = mesh.bounds
up = int(np.argmin(high - low))  # the shortest side of a terrain
draw = np.random.default_rng(1)
share = draw.random((2, 1_000_000, 3))
share[0, :, up] = 1 + 0.5 * share[0, :, up]  # from above, down to anywhere
share[1, :, up] *= 0.5
origins, targets = low + (high - low) * share
rays = np.concatenate([origins, targets - origins], axis=1).astype(np.float32)


def timed(name, call):
    start = time.perf_counter()
    result = call()
    print(f"{name:<44} {time.perf_counter() - start:6.2f} s")
    return result


timed("raypencil: tree, kept with the mesh", mesh.build)
exact = timed("raypencil: face and t, exact", lambda: raypencil.cast(mesh, rays, values=("face", "t")))
timed("raypencil: every value, correctly rounded", lambda: raypencil.cast(mesh, rays))
scene = o3d.t.geometry.RaycastingScene()
scene.add_triangles(mesh.vertices.astype(np.float32), mesh.faces)
tensor = o3d.core.Tensor(rays)
timed("Open3D: tree", lambda: scene.cast_rays(tensor[:1]))
told = timed("Open3D: face, t, normal, uv", lambda: scene.cast_rays(tensor))
face, t = told["primitive_ids"].numpy(), told["t_hit"].numpy()
same = exact.hit & np.isfinite(t) & (face == exact.face)
print(f"rays that hit: raypencil {exact.hit.sum()}, Open3D {np.isfinite(t).sum()}; another face: {(face != exact.face).sum()}")
print(f"largest difference of t: {np.abs(t[same] - exact.t[same]).max():.1e}")
