"""MuJoCo."""

from __future__ import annotations

import numpy as np

from ..._mesh import Mesh
from .._peer import Built, Hits, Peer, Rays, hits, need


class MuJoCo(Peer):
    """`mj_rayMesh`. It keeps vertices in single precision, turned into the mesh's axes of inertia, and computes in double."""

    name, title, package = "mujoco", "MuJoCo", "mujoco"
    arithmetic = mesh_type = "f32"
    rays_type = "f64"
    conventions = (
        "It tells no face; t alone is judged.",
        "`contype` and `conaffinity` are 0 here: of a mesh that may collide it makes a hull, and refuses one whose vertices lie in a plane.",
    )
    causes = (
        "Its test of triangles takes direction times twice the face's area below 1e-15 for 0 (`ray_triangle`, src/engine/engine_ray.c;"
        " `mjMINVAL`). The shortest direction that it answers is the root of 1e-15 long, at any size of the mesh.",
        "The boxes of its tree (`mjModel.bvh_aabb`) are those of the corners in double precision, and the corners are kept in single"
        " (`mjModel.mesh_vert`): a face pokes out of its box, and a ray that meets it there, as at vertices, passes (`mju_raySlab`).",
    )

    def build(self, mesh: Mesh) -> Built:
        mujoco = need("mujoco", self.package)
        spec = mujoco.MjSpec()
        made = spec.add_mesh(name="mesh")
        made.uservert = mesh.vertices.ravel().tolist()
        made.userface = mesh.faces.ravel().tolist()
        # Of an open mesh: the volume's inertia would be that of nothing.
        made.inertia = mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL
        spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_MESH, meshname="mesh", name="geom", contype=0, conaffinity=0)
        model = spec.compile()
        data = mujoco.MjData(model)
        mujoco.mj_forward(model, data)
        return mujoco, model, data

    def shoot(self, built: Built, rays: Rays) -> Hits:
        mujoco, model, data = built
        t = np.array([mujoco.mj_rayMesh(model, data, 0, ray[0:3], ray[3:6], None) for ray in rays])
        return hits(None, t, rays, is_hit=t >= 0)
