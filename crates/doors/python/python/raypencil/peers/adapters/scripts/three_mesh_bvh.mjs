import { answer, faces, load, vertices } from "./_question.mjs";

const THREE = await load("three");
const { MeshBVH } = await load("three-mesh-bvh");
const geometry = new THREE.BufferGeometry();
geometry.setAttribute("position", new THREE.Float32BufferAttribute(vertices, 3));
geometry.setIndex(new THREE.BufferAttribute(faces, 1));
// Otherwise it sorts the index, and numbers the faces anew.
const tree = new MeshBVH(geometry, { indirect: true });
const ray = new THREE.Ray();
answer((o, d) => {
  ray.origin.set(...o);
  ray.direction.set(...d);
  const found = tree.raycastFirst(ray, THREE.DoubleSide);
  return found === null ? null : [found.faceIndex, found.distance];
});
