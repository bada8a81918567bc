import { answer, faces, load, vertices } from "./_question.mjs";

const BABYLON = await load("@babylonjs/core");
const scene = new BABYLON.Scene(new BABYLON.NullEngine());
const mesh = new BABYLON.Mesh("mesh", scene);
const data = new BABYLON.VertexData();
data.positions = new Float32Array(vertices);
data.indices = faces;
data.applyToMesh(mesh);
mesh.computeWorldMatrix(true);
answer((o, d) => {
  const ray = new BABYLON.Ray(new BABYLON.Vector3(...o), new BABYLON.Vector3(...d), Number.MAX_VALUE);
  const found = mesh.intersects(ray);
  return found.hit ? [found.faceId, found.distance] : null;
});
