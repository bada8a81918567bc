"""How each peer is asked one ray in a few lines of its own: what a reproducer is made of.

The lines find `V` (corners), `F` (faces), `o` and `d` (origin and direction); programs that take segments also `e`, the segment's
end, and `T`, its t. They leave `face` (-1: none, or not told) and `t`. In Rust the names are `v`, `f`, `o` and `d`.
"""

from __future__ import annotations

_VTK = """import vtk
points, cells, data = vtk.vtkPoints(), vtk.vtkCellArray(), vtk.vtkPolyData()
points.SetDataTypeToDouble()
for v in V: points.InsertNextPoint(v)
for f in F: cells.InsertNextCell(3, f)
data.SetPoints(points); data.SetPolys(cells)
locator = vtk.{kind}(); locator.SetDataSet(data); locator.BuildLocator()
at, x, w, s, c = vtk.reference(0.0), [0.0] * 3, [0.0] * 3, vtk.reference(0), vtk.reference(-1)
hit = locator.IntersectWithLine(o, e, {tolerance}, at, x, w, s, c, vtk.vtkGenericCell())
face, t = (c.get(), at.get() * T) if hit else (-1, float("inf"))"""

_EMBREE = """from embreex.rtcore_scene import EmbreeScene
from embreex.mesh_construction import TriangleMesh
scene = EmbreeScene(robust={robust})
mesh = TriangleMesh(scene, np.array(V, np.float32), np.array(F, np.int32))
told = scene.run(np.array([o], np.float32), np.array([d], np.float32), output=1)
face = int(told["primID"].astype(np.int32)[0])
t = float(told["tfar"][0]) if face >= 0 else float("inf")"""

_MITSUBA = """import mitsuba as mi
mi.set_variant("{variant}")
mesh = mi.Mesh("mesh", len(V), len(F)); p = mi.traverse(mesh)
p["vertex_positions"] = np.ravel(np.array(V, np.float32)); p["faces"] = np.ravel(np.array(F, np.uint32)); p.update()
found = mi.load_dict({{"type": "scene", "mesh": mesh}}).ray_intersect_preliminary(mi.Ray3f(mi.Point3f(o), mi.Vector3f(d)){more})
face, t = (int({index}), float({at})) if {valid} else (-1, float("inf"))"""

_WARP = """import warp as wp
@wp.kernel
def first(mesh: wp.uint64, o: wp.vec3, d: wp.vec3, face: wp.array(dtype=int), t: wp.array(dtype=float)):
    q = wp.mesh_query_ray(mesh, o, d, 3.0e38)
    if q.result:
        face[0] = q.face; t[0] = q.t
wp.set_device("{place}")
mesh = wp.Mesh(wp.array(V, dtype=wp.vec3), wp.array(np.ravel(F), dtype=wp.int32))
face, t = wp.full(1, -1, dtype=int), wp.full(1, float("inf"), dtype=float)
wp.launch(first, dim=1, inputs=[mesh.id, wp.vec3(*o), wp.vec3(*d), face, t])
face, t = int(face.numpy()[0]), float(t.numpy()[0])"""

_TRIMESH = """import trimesh
from trimesh.ray.{module} import RayMeshIntersector
rays = RayMeshIntersector(trimesh.Trimesh(V, F, process=False, validate=False))
faces, _, points = rays.intersects_id([o], [d], return_locations=True, multiple_hits={many})
ts = [float(np.dot(p - o, d) / np.dot(d, d)) for p in points]
t, face = min([(t, int(f)) for t, f in zip(ts, faces) if t >= 0], default=(float("inf"), -1))"""

_MESHLIB = """from meshlib import mrmeshnumpy, mrmeshpy as mr
part = mr.MeshPart(mrmeshnumpy.meshFromFacesVerts(np.array(F, np.int32), np.array(V, float)))
found = mr.rayMeshIntersect(part, mr.Line3{kind}(mr.Vector3{kind}(*o), mr.Vector3{kind}(*d)))
hit = found.proj.face.valid()
face, t = (found.proj.face.get(), found.distanceAlongLine) if hit else (-1, float("inf"))"""

_THREE = """import * as THREE from "three";
const geometry = new THREE.BufferGeometry();
geometry.setAttribute("position", new THREE.Float32BufferAttribute(V.flat(), 3));
geometry.setIndex(F.flat());
"""

#: In Python, by the names of the peers.
PYTHON = {
    "embree": _EMBREE.format(robust=False),
    "embree-robust": _EMBREE.format(robust=True),
    "open3d": """import open3d as o3d
scene = o3d.t.geometry.RaycastingScene()
scene.add_triangles(np.array(V, np.float32), np.array(F, np.uint32))
found = scene.cast_rays(o3d.core.Tensor(np.array([o + d], np.float32)))
t = float(found["t_hit"].numpy()[0])
face = int(found["primitive_ids"].numpy()[0]) if np.isfinite(t) else -1""",
    "mitsuba-scalar": _MITSUBA.format(
        variant="scalar_rgb", more="", index="found.prim_index", at="found.t", valid="found.is_valid()"
    ),
    "mitsuba-llvm": _MITSUBA.format(
        variant="llvm_ad_rgb", more="", index="found.prim_index[0]", at="found.t[0]", valid="found.is_valid()[0]"
    ),
    "mitsuba-cuda": _MITSUBA.format(
        variant="cuda_ad_rgb", more="", index="found.prim_index[0]", at="found.t[0]", valid="found.is_valid()[0]"
    ),
    "pcu": """import point_cloud_utils as pcu
rays = pcu.RayMeshIntersector(np.array(V, np.float32), np.array(F, np.int32))
face, _, t = rays.intersect_rays(np.array([o], np.float32), np.array([d], np.float32))
face, t = int(np.ravel(face)[0]), float(np.ravel(t)[0])""",
    "libigl-embree": """import igl.embree
tree = igl.embree.EmbreeIntersector()
v, f = np.asfortranarray(V, np.float32), np.asfortranarray(F, np.int32)
tree.init(v, f)
face, t, _, _ = tree.intersectRay_first(np.array(o, np.float32), np.array(d, np.float32))
t = t if face >= 0 else float("inf")""",
    "trimesh-embree": _TRIMESH.format(module="ray_pyembree", many=False),
    "trimesh": _TRIMESH.format(module="ray_triangle", many=True),
    "libigl": """import igl
v, f = np.array(V, float), np.array(F, np.int64)
tree = igl.AABB(); tree.init(v, f)
face, t, _ = tree.intersect_ray_first(v, f, np.array([o], float), np.array([d], float))
face, t = int(face[0]), float(t[0])""",
    "libigl-brute": """import igl
found = igl.ray_mesh_intersect(np.array(o, float), np.array(d, float), np.array(V, float), np.array(F, np.int64))
face, t = found[0][:2] if found else (-1, float("inf"))""",
    "vtk-obb": _VTK.format(kind="vtkOBBTree", tolerance="0.0"),
    "vtk-obb-all": """import vtk
points, cells, data = vtk.vtkPoints(), vtk.vtkCellArray(), vtk.vtkPolyData()
points.SetDataTypeToDouble()
for v in V: points.InsertNextPoint(v)
for f in F: cells.InsertNextCell(3, f)
data.SetPoints(points); data.SetPolys(cells)
tree = vtk.vtkOBBTree(); tree.SetDataSet(data); tree.BuildLocator()
found, faces = vtk.vtkPoints(), vtk.vtkIdList(); found.SetDataTypeToDouble()
tree.IntersectWithLine(o, e, found, faces)
hit = faces.GetNumberOfIds() > 0
face, t = (faces.GetId(0), float(np.dot(np.subtract(found.GetPoint(0), o), d) / np.dot(d, d))) if hit else (-1, float("inf"))""",
    "vtk-cells": _VTK.format(kind="vtkCellLocator", tolerance="0.0"),
    "vtk-static": _VTK.format(kind="vtkStaticCellLocator", tolerance="0.0"),
    "vtk-tolerance": _VTK.format(kind="vtkStaticCellLocator", tolerance="1e-12 * np.ptp(V, axis=0).max()"),
    "vtk-bsp": _VTK.format(kind="vtkModifiedBSPTree", tolerance="0.0"),
    "vtk-cell-tree": _VTK.format(kind="vtkCellTreeLocator", tolerance="0.0"),
    "warp": _WARP.format(place="cpu"),
    "warp-cuda": _WARP.format(place="cuda:0"),
    "fcpw": """import fcpw
scene = fcpw.scene_3D(); scene.set_object_count(1)
scene.set_object_vertices(np.asfortranarray(V, np.float32), 0)
scene.set_object_triangles(np.asfortranarray(F, np.int32), 0)
scene.build(fcpw.aggregate_type.bvh_surface_area, True, False, False)
rays = [np.asfortranarray([o], np.float32), np.asfortranarray([d], np.float32), np.array([3e38], np.float32)]
found = fcpw.interaction_3D_list(); scene.intersect(*rays, found)
hit = 0 <= found[0].primitive_index < len(F) and found[0].d < 3e38
face, t = (found[0].primitive_index, found[0].d) if hit else (-1, float("inf"))""",
    "meshlib": _MESHLIB.format(kind="f"),
    "meshlib-double": _MESHLIB.format(kind="d"),
    "cgal": """from CGAL.CGAL_Kernel import Point_3, Ray_3, Triangle_3, Vector_3
from CGAL.CGAL_AABB_tree import AABB_tree_Triangle_3_soup
tree = AABB_tree_Triangle_3_soup([Triangle_3(*(Point_3(*V[i]) for i in f)) for f in F])
found = []; tree.all_intersections(Ray_3(Point_3(*o), Vector_3(*d)), found)
ends = [(h.first.get_Point_3() if h.first.is_Point_3() else h.first.get_Segment_3().source(), h.second) for h in found]
ts = [(float(np.dot([p.x() - o[0], p.y() - o[1], p.z() - o[2]], d) / np.dot(d, d)), int(k)) for p, k in ends]
t, face = min(ts, default=(float("inf"), -1))""",
    "pyraymesh": """from pyraymesh import Mesh
mesh = Mesh(np.array(V, np.float32), np.array(F, np.int32)); mesh.build("medium")
found = mesh.intersect([o], [d])
face, t = -1, float(found.distances[0]) if found.tri_ids[0] >= 0 else float("inf")""",
    "ncollpyde": """import ncollpyde
volume = ncollpyde.Volume(np.array(V, float), np.array(F), validate=False, n_rays=0)
_, points, _ = volume.intersections([o], [e], threads=False)
face, t = -1, float(np.dot(points[0] - o, d) / np.dot(d, d)) if len(points) else float("inf")""",
    "mujoco": """import mujoco
spec = mujoco.MjSpec(); mesh = spec.add_mesh(name="mesh")
mesh.uservert, mesh.userface = np.ravel(V).tolist(), np.ravel(F).tolist()
mesh.inertia = mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL
spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_MESH, meshname="mesh", contype=0, conaffinity=0)
model = spec.compile(); data = mujoco.MjData(model); mujoco.mj_forward(model, data)
t = mujoco.mj_rayMesh(model, data, 0, np.array(o), np.array(d), None)
face, t = -1, t if t >= 0 else float("inf")""",
    "pybullet": """import pybullet
pybullet.connect(pybullet.DIRECT)
shape = pybullet.createCollisionShape(pybullet.GEOM_MESH, vertices=V, indices=np.ravel(F).tolist(),
                                      flags=pybullet.GEOM_FORCE_CONCAVE_TRIMESH)
pybullet.createMultiBody(0, shape)
body, _, fraction, _, _ = pybullet.rayTest(o, e)[0]
face, t = -1, fraction * T if body >= 0 else float("inf")""",
    "panda3d": """from panda3d import core
root, ray = core.NodePath("root"), core.CollisionRay(*o, *d)
for k, f in enumerate(F):
    node = core.CollisionNode(str(k)); node.add_solid(core.CollisionPolygon(*(core.Point3(*V[i]) for i in f))); root.attach_new_node(node)
shooter = core.CollisionNode("ray"); shooter.add_solid(ray)
traverser, queue = core.CollisionTraverser(), core.CollisionHandlerQueue()
traverser.add_collider(root.attach_new_node(shooter), queue); traverser.traverse(root)
hits = [(one.get_surface_point(root), int(one.get_into_node().name)) for one in queue.entries]
ts = [(float(np.dot(np.array(p) - o, d) / np.dot(d, d)), k) for p, k in hits]
t, face = min(ts, default=(float("inf"), -1))""",
    "raylib": """import pyray
ray = pyray.Ray(pyray.Vector3(*o), pyray.Vector3(*d))
found = [pyray.get_ray_collision_triangle(ray, *(pyray.Vector3(*V[i]) for i in f)) for f in F]
t, face = min([(one.distance, k) for k, one in enumerate(found) if one.hit], default=(float("inf"), -1))""",
    "raysect": """from raysect.core import Point3D, Ray, Vector3D, World
from raysect.primitive import Mesh
world = World(); mesh = Mesh(np.array(V), np.array(F), closed=False, smoothing=False, parent=world)
found = mesh.hit(Ray(Point3D(*o), Vector3D(*d)))
face, t = (found.triangle, found.ray_distance) if found else (-1, float("inf"))""",
    "usd": """from pxr import Gf
ray = Gf.Ray(Gf.Vec3d(*o), Gf.Vec3d(*d))
found = [ray.Intersect(*(Gf.Vec3d(*V[i]) for i in f)) for f in F]
t, face = min([(one[1], k) for k, one in enumerate(found) if one[0] and one[1] >= 0], default=(float("inf"), -1))""",
}

#: In JavaScript.
NODE = {
    "three": _THREE
    + """const mesh = new THREE.Mesh(geometry, new THREE.MeshBasicMaterial({ side: THREE.DoubleSide }));
const found = new THREE.Raycaster(new THREE.Vector3(...o), new THREE.Vector3(...d)).intersectObject(mesh)[0];
const [face, t] = found ? [found.faceIndex, found.distance] : [-1, Infinity];""",
    "three-mesh-bvh": """import { MeshBVH } from "three-mesh-bvh";
"""
    + _THREE
    + """const ray = new THREE.Ray(new THREE.Vector3(...o), new THREE.Vector3(...d));
const found = new MeshBVH(geometry, { indirect: true }).raycastFirst(ray, THREE.DoubleSide);
const [face, t] = found ? [found.faceIndex, found.distance] : [-1, Infinity];""",
    "babylon": """import * as BABYLON from "@babylonjs/core";
const mesh = new BABYLON.Mesh("mesh", new BABYLON.Scene(new BABYLON.NullEngine()));
const data = new BABYLON.VertexData();
data.positions = new Float32Array(V.flat()); data.indices = F.flat();
data.applyToMesh(mesh); mesh.computeWorldMatrix(true);
const found = mesh.intersects(new BABYLON.Ray(new BABYLON.Vector3(...o), new BABYLON.Vector3(...d), Number.MAX_VALUE));
const [face, t] = found.hit ? [found.faceId, found.distance] : [-1, Infinity];""",
    "rapier": """import RAPIER from "@dimforge/rapier3d-compat";
await RAPIER.init();
const world = new RAPIER.World({ x: 0, y: 0, z: 0 });
const mesh = RAPIER.ColliderDesc.trimesh(new Float32Array(V.flat()), new Uint32Array(F.flat()));
const xyz = ([x, y, z]) => ({ x, y, z });
const ray = new RAPIER.Ray(xyz(o), xyz(d));
const found = world.createCollider(mesh).castRayAndGetNormal(ray, 3.4e38, false);
const [face, t] = [-1, found ? found.timeOfImpact : Infinity];""",
    "jolt": """import load from "jolt-physics";
const Jolt = await load();
const corners = new Jolt.VertexList(), triangles = new Jolt.IndexedTriangleList();
for (const v of V) corners.push_back(new Jolt.Float3(...v));
F.forEach((f, k) => triangles.push_back(new Jolt.IndexedTriangle(...f, 0, k)));
const made = new Jolt.MeshShapeSettings(corners, triangles, new Jolt.PhysicsMaterialList());
made.mPerTriangleUserData = true;
const shape = Jolt.castObject(made.Create().Get(), Jolt.MeshShape);
const settings = new Jolt.JoltSettings(), pairs = new Jolt.ObjectLayerPairFilterTable(1);
const broad = new Jolt.BroadPhaseLayerInterfaceTable(1, 1);
broad.MapObjectToBroadPhaseLayer(0, new Jolt.BroadPhaseLayer(0));
settings.mObjectLayerPairFilter = pairs; settings.mBroadPhaseLayerInterface = broad;
settings.mObjectVsBroadPhaseLayerFilter = new Jolt.ObjectVsBroadPhaseLayerFilterTable(broad, 1, pairs, 1);
const physics = new Jolt.JoltInterface(settings).GetPhysicsSystem();
const body = new Jolt.BodyCreationSettings(shape, new Jolt.RVec3(0, 0, 0), new Jolt.Quat(0, 0, 0, 1), Jolt.EMotionType_Static, 0);
physics.GetBodyInterface().CreateAndAddBody(body, Jolt.EActivation_DontActivate);
const how = new Jolt.RayCastSettings(); how.mBackFaceModeTriangles = Jolt.EBackFaceMode_CollideWithBackFaces;
const filters = [new Jolt.BroadPhaseLayerFilter(), new Jolt.ObjectLayerFilter(), new Jolt.BodyFilter(), new Jolt.ShapeFilter()];
const ray = new Jolt.RRayCast(new Jolt.RVec3(...o), new Jolt.Vec3(...e.map((x, k) => x - o[k])));
const found = new Jolt.CastRayClosestHitCollisionCollector();
physics.GetNarrowPhaseQuery().CastRay(ray, how, found, ...filters);
const hit = found.HadHit();
const [face, t] = hit ? [shape.GetTriangleUserData(found.mHit.mSubShapeID2), found.mHit.mFraction * T] : [-1, Infinity];""",
    "cannon-es": """import * as CANNON from "cannon-es";
const world = new CANNON.World();
world.addBody(new CANNON.Body({ mass: 0, shape: new CANNON.Trimesh(V.flat(), F.flat()) }));
const found = new CANNON.RaycastResult();
const way = { skipBackfaces: false, checkCollisionResponse: false };
world.raycastClosest(new CANNON.Vec3(...o), new CANNON.Vec3(...e), way, found);
const [face, t] = [-1, found.hasHit ? found.distance / Math.hypot(...d) : Infinity];""",
}

_PARRY = """    use {crate}::{{math::Vector, query::{{Ray, RayCast}}, shape::TriMesh}};
    let vector = |p: [f64; 3]| Vector::new(p[0] as {real}, p[1] as {real}, p[2] as {real});
    let mesh = TriMesh::new(v.into_iter().map(vector).collect(), f).unwrap();
    let found = mesh.cast_local_ray_and_get_normal(&Ray::new(vector(o), vector(d)), {real}::MAX, false);
    let (face, t) = found.map_or((-1, f64::INFINITY), |hit| (hit.subshape as i64, hit.time_of_impact as f64));"""

#: The test alone: a tree only finds the faces whose boxes a ray meets.
_BVH = """    use nalgebra::{{Point3, Vector3}};
    let point = |p: [f64; 3]| Point3::from(p.map(|x| x as {real}));
    let ray = bvh::ray::Ray::new(point(o), Vector3::from(d.map(|x| x as {real})));
    let (mut face, mut t) = (-1, f64::INFINITY);
    for (k, corners) in f.iter().enumerate() {{
        let [a, b, c] = corners.map(|index| point(v[index as usize]));
        // Its test leaves out backs.
        let at = ray.intersects_triangle(&a, &b, &c).distance.min(ray.intersects_triangle(&a, &c, &b).distance) as f64;
        if at < t {{
            (face, t) = (k as i64, at);
        }}
    }}"""

_OBVHS = """    use obvhs::{{ray::{{Ray, RayHit}}, triangle::Triangle, BvhBuildParams}};
    let vector = |p: [f64; 3]| glam::Vec3A::from_array(p.map(|x| x as f32));
    let triangle = |[a, b, c]: [u32; 3]| [a, b, c].map(|index| vector(v[index as usize]));
    let triangles: Vec<Triangle> = f.into_iter().map(triangle).map(|[v0, v1, v2]| Triangle {{ v0, v1, v2 }}).collect();
    let tree = obvhs::{build}(&triangles, BvhBuildParams::medium_build(), &mut Default::default());
    let mut hit = RayHit::none();
    let is_hit = tree.ray_traverse(Ray::new_inf(vector(o), vector(d.map(|x| x + 0.0))), &mut hit, |ray, id| {{
        triangles[tree.primitive_indices[id] as usize].intersect(ray)
    }});
    let (face, t) =
        if is_hit {{ (tree.primitive_indices[hit.primitive_id as usize] as i64, hit.t as f64) }} else {{ (-1, f64::INFINITY) }};"""

#: In Rust, the inside of `main`; and the crates that it needs beside the peer's own. tinybvh, a header of C++, has none.
RUST = {
    "parry": (_PARRY.format(crate="parry3d", real="f32"), ()),
    "parry-f64": (_PARRY.format(crate="parry3d_f64", real="f64"), ()),
    "bvh": (_BVH.format(real="f32"), ('nalgebra = "0.35"',)),
    "bvh-f64": (_BVH.format(real="f64"), ('nalgebra = "0.35"',)),
    "obvhs": (_OBVHS.format(build="bvh2::builder::build_bvh2_from_tris"), ('glam = "0.34"',)),
    "obvhs-cwbvh": (_OBVHS.format(build="cwbvh::builder::build_cwbvh_from_tris"), ('glam = "0.34"',)),
}
