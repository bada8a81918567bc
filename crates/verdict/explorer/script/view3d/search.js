// The search for faces: a plain loop over all of them in double precision, in parts, so that the page stays
// alive.

import { vecLength } from './vector.js';

/** @typedef {import('./vector.js').Point3} Point3 */
/** @typedef {import('./sensor.js').Ray3} Ray3 */
/** @typedef {import('./terrain.js').Terrain} Terrain */
/**
 * @typedef {object} SearchLimits
 * @property {number} from smallest multiple of the direction that counts
 * @property {number} to largest one
 * @property {boolean} frontsOnly whether faces seen from behind are passed through
 * @property {Set<number>} [skip] faces that are passed through
 */

/** Faces in one part: some 5 ms of work. */
const FACES_IN_A_PART = 200000;

/** Lets the page do something else. @returns {Promise<void>} */
function searchPause() {
  return new Promise((resolve) => setTimeout(resolve, 0));
}

/**
 * The first face that a ray meets, or null. Edges and vertices belong to their faces.
 * @param {Terrain} terrain
 * @param {Ray3} ray
 * @param {SearchLimits} limits
 * @param {() => boolean} [isStale] asked between parts: true ends the search
 * @returns {Promise<{face: number, t: number} | null>}
 */
export async function firstFaceOnRay(terrain, ray, limits, isStale) {
  const best = { face: -1, t: limits.to };
  for (let start = 0; start < terrain.faceCount; start += FACES_IN_A_PART) {
    if (start > 0) {
      await searchPause();
      if (isStale && isStale()) return null;
    }
    searchPart(terrain, ray, limits, start, Math.min(start + FACES_IN_A_PART, terrain.faceCount), best);
  }
  return best.face < 0 ? null : best;
}

/**
 * One part of the loop.
 * @param {Terrain} terrain
 * @param {Ray3} ray
 * @param {SearchLimits} limits
 * @param {number} start
 * @param {number} end
 * @param {{face: number, t: number}} best
 */
function searchPart(terrain, ray, limits, start, end, best) {
  for (let face = start; face < end; face++) {
    const t = hitOfFace(terrain, ray, face, limits.frontsOnly);
    if (!(t >= limits.from) || t > best.t || (t === best.t && best.face >= 0)) continue;
    if (limits.skip && limits.skip.has(face)) continue;
    best.face = face;
    best.t = t;
  }
}

/**
 * Where a ray meets a face, as a multiple of its direction; NaN if it does not. It is inside if the three volumes that
 * it spans with the sides have one sign; two faces that share a side compute the same number for it, but for the sign.
 * @param {{vertices: Float32Array, faces: Uint32Array}} mesh
 * @param {Ray3} ray
 * @param {number} face
 * @param {boolean} frontsOnly whether a face that is seen from behind is passed through
 */
export function hitOfFace({ vertices, faces }, { origin, direction }, face, frontsOnly) {
  const ia = 3 * faces[3 * face];
  const ib = 3 * faces[3 * face + 1];
  const ic = 3 * faces[3 * face + 2];
  const qx = direction[0];
  const qy = direction[1];
  const qz = direction[2];
  const ax = vertices[ia] - origin[0];
  const ay = vertices[ia + 1] - origin[1];
  const az = vertices[ia + 2] - origin[2];
  const bx = vertices[ib] - origin[0];
  const by = vertices[ib + 1] - origin[1];
  const bz = vertices[ib + 2] - origin[2];
  const ab = qx * (ay * bz - by * az) + qy * (az * bx - bz * ax) + qz * (ax * by - bx * ay);
  const cx = vertices[ic] - origin[0];
  const cy = vertices[ic + 1] - origin[1];
  const cz = vertices[ic + 2] - origin[2];
  const bc = qx * (by * cz - cy * bz) + qy * (bz * cx - cz * bx) + qz * (bx * cy - cx * by);
  if ((ab < 0 && bc > 0) || (ab > 0 && bc < 0)) return NaN;
  const ca = qx * (cy * az - ay * cz) + qy * (cz * ax - az * cx) + qz * (cx * ay - ax * cy);
  // A face without such a vertex has no number here.
  if (!((ab <= 0 && bc <= 0 && ca <= 0) || (ab >= 0 && bc >= 0 && ca >= 0))) return NaN;
  const ux = bx - ax;
  const uy = by - ay;
  const uz = bz - az;
  const vx = cx - ax;
  const vy = cy - ay;
  const vz = cz - az;
  const nx = uy * vz - vy * uz;
  const ny = uz * vx - vz * ux;
  const nz = ux * vy - vx * uy;
  const nq = nx * qx + ny * qy + nz * qz;
  return nq === 0 || (frontsOnly && nq > 0) ? NaN : (nx * ax + ny * ay + nz * az) / nq;
}

/**
 * Faces whose boxes come within a distance of a point, at most so many, the nearest first.
 * @param {Terrain} terrain
 * @param {Point3} point
 * @param {number} radius metres
 * @param {number} most
 * @param {() => boolean} [isStale]
 * @returns {Promise<number[]>}
 */
export async function facesNearPoint(terrain, point, radius, most, isStale) {
  const { vertices, faces } = terrain;
  /** @type {{face: number, distance: number}[]} */
  const found = [];
  for (let face = 0; face < terrain.faceCount; face++) {
    if (face > 0 && face % FACES_IN_A_PART === 0) {
      await searchPause();
      if (isStale && isStale()) return [];
    }
    let squares = 0;
    for (let axis = 0; axis < 3; axis++) {
      const a = vertices[3 * faces[3 * face] + axis];
      const b = vertices[3 * faces[3 * face + 1] + axis];
      const c = vertices[3 * faces[3 * face + 2] + axis];
      const low = a < b ? (a < c ? a : c) : b < c ? b : c;
      const high = a > b ? (a > c ? a : c) : b > c ? b : c;
      const gap = point[axis] < low ? low - point[axis] : point[axis] > high ? point[axis] - high : 0;
      squares += gap * gap;
    }
    if (squares <= radius * radius) found.push({ face, distance: squares });
  }
  found.sort((a, b) => a.distance - b.distance);
  return found.slice(0, most).map((entry) => entry.face);
}

/**
 * The first front that a ray of a sensor meets, by the rules of the sensor: at or beyond the projection plane
 * (t >= 1) and within the longest range along the ray.
 * @param {Terrain} terrain
 * @param {Ray3} ray
 * @param {number} maxRange metres
 * @param {() => boolean} [isStale]
 */
export function firstHitOfSensor(terrain, ray, maxRange, isStale) {
  const to = maxRange / vecLength(ray.direction);
  return firstFaceOnRay(terrain, ray, { from: 1, to, frontsOnly: true }, isStale);
}
