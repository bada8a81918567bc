import { answer, faces, load, vertices } from "./_question.mjs";

const THREE = await load("three");
const geometry = new THREE.BufferGeometry();
geometry.setAttribute("position", new THREE.Float32BufferAttribute(vertices, 3));
geometry.setIndex(new THREE.BufferAttribute(faces, 1));
const mesh = new THREE.Mesh(geometry, new THREE.MeshBasicMaterial({ side: THREE.DoubleSide }));
const caster = new THREE.Raycaster();
answer((o, d) => {
  caster.set(new THREE.Vector3(...o), new THREE.Vector3(...d));
  const found = caster.intersectObject(mesh, false);
  return found.length === 0 ? null : [found[0].faceIndex, found[0].distance];
});
