import { answer, faces, load, vertices } from "./_question.mjs";

const loaded = await load("@dimforge/rapier3d-compat");
const RAPIER = loaded.default ?? loaded;
await RAPIER.init();
const world = new RAPIER.World({ x: 0, y: 0, z: 0 });
// A shape alone would be made anew for each ray.
const collider = world.createCollider(RAPIER.ColliderDesc.trimesh(new Float32Array(vertices), faces));
answer((o, d, end) => {
  const ray = new RAPIER.Ray({ x: o[0], y: o[1], z: o[2] }, { x: d[0], y: d[1], z: d[2] });
  const found = collider.castRayAndGetNormal(ray, Math.min(end, 3.4028234663852886e38), false);
  // Its feature is 0 or 1, the side of the face: it does not say which face.
  return found === null ? null : [0, found.timeOfImpact];
}, false);
