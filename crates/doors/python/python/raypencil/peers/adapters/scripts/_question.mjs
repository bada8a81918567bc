// What the scripts have in common: the question is read, the package is found, the answers are written.
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

const [, , root, folder] = process.argv;
const bytes = (name) => {
  const file = readFileSync(join(folder, name));
  return file.buffer.slice(file.byteOffset, file.byteOffset + file.byteLength);
};

export const vertices = new Float64Array(bytes("vertices"));
export const faces = new Uint32Array(bytes("faces"));
// Eight numbers for each ray: origin, direction, t_min, t_max.
export const rays = new Float64Array(bytes("rays"));

// A package in another folder, as `import` would find it there.
export async function load(name) {
  const at = join(root, "node_modules", name);
  const says = JSON.parse(readFileSync(join(at, "package.json"), "utf8"));
  const entry = says.exports?.["."]?.import ?? says.module ?? says.exports?.["."]?.default ?? says.main;
  return import(pathToFileURL(join(at, entry)).href);
}

// first(origin, direction, end) gives [face, t], or null.
export function answer(first, hasFaces = true) {
  const count = rays.length / 8;
  const face = new Int32Array(count).fill(-1);
  const t = new Float64Array(count).fill(Infinity);
  const start = performance.now();
  for (let k = 0; k < count; k += 1) {
    const found = first(rays.subarray(8 * k, 8 * k + 3), rays.subarray(8 * k + 3, 8 * k + 6), rays[8 * k + 7]);
    if (found !== null) {
      face[k] = found[0];
      t[k] = found[1];
    }
  }
  const spent = performance.now() - start;
  writeFileSync(join(folder, "t"), new Uint8Array(t.buffer));
  if (hasFaces) writeFileSync(join(folder, "face"), new Uint8Array(face.buffer));
  console.log(spent);
}
