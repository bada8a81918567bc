import { answer, faces, load, vertices } from "./_question.mjs";

const loaded = await load("@dimforge/rapier3d-compat");
const RAPIER = loaded.default ?? loaded;
await RAPIER.init();
const shape = new RAPIER.TriMesh(new Float32Array(vertices), faces);
const zero = { x: 0, y: 0, z: 0 };
const unturned = { x: 0, y: 0, z: 0, w: 1 };
answer((o, d, end) => {
  const ray = new RAPIER.Ray({ x: o[0], y: o[1], z: o[2] }, { x: d[0], y: d[1], z: d[2] });
  const found = shape.castRayAndGetNormal(ray, zero, unturned, Math.min(end, 3.4028234663852886e38), false);
  // Its feature is 0 or 1, the side of the face: it does not say which face.
  return found === null ? null : [0, found.timeOfImpact];
}, false);
