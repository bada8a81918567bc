import { answer, faces, load, vertices } from "./_question.mjs";

const CANNON = await load("cannon-es");
const world = new CANNON.World();
const body = new CANNON.Body({ mass: 0, shape: new CANNON.Trimesh(Array.from(vertices), Array.from(faces)) });
world.addBody(body);
answer((o, d) => {
  const start = new CANNON.Vec3(...o);
  const end = new CANNON.Vec3(o[0] + d[0], o[1] + d[1], o[2] + d[2]);
  const found = new CANNON.RaycastResult();
  world.raycastClosest(start, end, { skipBackfaces: false, checkCollisionResponse: false }, found);
  // `hitFaceIndex` is that of the last face that was tried with success, not of the nearest.
  return found.hasHit ? [0, found.distance / Math.hypot(...d)] : null;
}, false);
