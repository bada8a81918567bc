import { answer, faces, load, vertices } from "./_question.mjs";

const Jolt = await (await load("jolt-physics")).default();
const corners = new Jolt.VertexList();
for (let k = 0; k < vertices.length; k += 3) corners.push_back(new Jolt.Float3(vertices[k], vertices[k + 1], vertices[k + 2]));
const triangles = new Jolt.IndexedTriangleList();
for (let k = 0; k < faces.length; k += 3) triangles.push_back(new Jolt.IndexedTriangle(faces[k], faces[k + 1], faces[k + 2], 0, k / 3));
const shape = new Jolt.MeshShapeSettings(corners, triangles, new Jolt.PhysicsMaterialList());
// Otherwise the numbers that a hit tells are its own, and say not which face it is.
shape.mPerTriangleUserData = true;
const made = shape.Create();
if (made.HasError()) throw new Error(made.GetError().c_str());

// A world of one body that does not move: a shape alone takes no ray in JavaScript.
const settings = new Jolt.JoltSettings();
const pairs = new Jolt.ObjectLayerPairFilterTable(1);
const broad = new Jolt.BroadPhaseLayerInterfaceTable(1, 1);
broad.MapObjectToBroadPhaseLayer(0, new Jolt.BroadPhaseLayer(0));
settings.mObjectLayerPairFilter = pairs;
settings.mBroadPhaseLayerInterface = broad;
settings.mObjectVsBroadPhaseLayerFilter = new Jolt.ObjectVsBroadPhaseLayerFilterTable(broad, 1, pairs, 1);
const physics = new Jolt.JoltInterface(settings).GetPhysicsSystem();
const bodies = physics.GetBodyInterface();
const place = [new Jolt.RVec3(0, 0, 0), new Jolt.Quat(0, 0, 0, 1)];
const body = new Jolt.BodyCreationSettings(made.Get(), ...place, Jolt.EMotionType_Static, 0);
bodies.CreateAndAddBody(body, Jolt.EActivation_DontActivate);

const mesh = Jolt.castObject(made.Get(), Jolt.MeshShape);
const how = new Jolt.RayCastSettings();
how.mBackFaceModeTriangles = Jolt.EBackFaceMode_CollideWithBackFaces;
const filters = [new Jolt.BroadPhaseLayerFilter(), new Jolt.ObjectLayerFilter(), new Jolt.BodyFilter(), new Jolt.ShapeFilter()];
const query = physics.GetNarrowPhaseQuery();
const found = new Jolt.CastRayClosestHitCollisionCollector();
answer((o, d) => {
  const ray = new Jolt.RRayCast(new Jolt.RVec3(...o), new Jolt.Vec3(...d));
  found.Reset();
  query.CastRay(ray, how, found, ...filters);
  Jolt.destroy(ray);
  return found.HadHit() ? [mesh.GetTriangleUserData(found.mHit.mSubShapeID2), found.mHit.mFraction] : null;
});
