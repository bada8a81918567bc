// A coarse terrain of fewer faces, for slow pictures while the eye moves: near vertices become one.

import { Terrain } from './terrain.js';

/** Cells along the longer side of the terrain. */
const COARSE_CELLS = 130;

/** Side of a cell, metres. @param {Terrain} terrain */
export function coarseCellSize(terrain) {
  const { bounds } = terrain;
  if (!bounds) return 1;
  const sides = [0, 1, 2].map((axis) => bounds.high[axis] - bounds.low[axis]);
  return Math.max(...sides, 1e-9) / COARSE_CELLS;
}

/**
 * Puts vertices of one cubic cell together, and keeps the faces whose corners are in three cells. Each vertex
 * that is kept is one of the terrain's own.
 * @param {Terrain} terrain
 * @returns {{terrain: Terrain, faceOf: Uint32Array}} `faceOf`: the face that each face of the coarse terrain
 *   was
 */
export function coarseTerrain(terrain) {
  const { vertices, faces, bounds } = terrain;
  const [x0, y0, z0] = bounds ? bounds.low : [0, 0, 0];
  const scale = 1 / coarseCellSize(terrain);
  const vertexCount = Math.floor(vertices.length / 3);
  /** Vertex that stands for each vertex. */
  const stands = new Uint32Array(vertexCount);
  /** @type {Map<number, number>} */
  const firstInCell = new Map();
  const side = COARSE_CELLS + 2;
  for (let vertex = 0; vertex < vertexCount; vertex++) {
    const x = Math.floor((vertices[3 * vertex] - x0) * scale);
    const y = Math.floor((vertices[3 * vertex + 1] - y0) * scale);
    const z = Math.floor((vertices[3 * vertex + 2] - z0) * scale);
    const cell = (z * side + y) * side + x;
    const first = firstInCell.get(cell);
    if (first === undefined) firstInCell.set(cell, vertex);
    stands[vertex] = first ?? vertex;
  }
  /** @type {number[]} */
  const kept = [];
  /** @type {number[]} */
  const faceOf = [];
  for (let face = 0; face < terrain.faceCount; face++) {
    if (!terrain.hasFace(face)) continue;
    const a = stands[faces[3 * face]];
    const b = stands[faces[3 * face + 1]];
    const c = stands[faces[3 * face + 2]];
    if (a === b || b === c || c === a) continue;
    kept.push(a, b, c);
    faceOf.push(face);
  }
  const materials = new Uint16Array(faceOf.map((face) => terrain.materials[face] ?? 0));
  return {
    terrain: new Terrain(vertices, Uint32Array.from(kept), materials),
    faceOf: Uint32Array.from(faceOf),
  };
}
