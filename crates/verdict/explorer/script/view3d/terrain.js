// The terrain as numbers: checked faces, their normals, its bounds, and the order of vertices that its
// drawing needs.

import { vecCross, vecDot, vecLength, vecSub } from './vector.js';

/** @typedef {import('./vector.js').Point3} Point3 */
/** @typedef {{low: Point3, high: Point3}} Bounds3 */

/** Vertices, faces and materials of the page model, and what follows from them. */
export class Terrain {
  /**
   * @param {Float32Array} vertices three numbers each, metres in the scene frame
   * @param {Uint32Array} faces three vertices each
   * @param {Uint16Array} materials one each face
   */
  constructor(vertices, faces, materials) {
    this.vertices = vertices;
    this.faces = faces;
    this.materials = materials;
    this.faceCount = Math.floor(faces.length / 3);
    /** Unit normals as signed bytes, four each face (the fourth is 0), for drawing. */
    this.normals = new Int8Array(4 * this.faceCount);
    /** Faces that name a vertex that is not there, or one that is no number. They are left out. */
    this.brokenFaces = 0;
    /** Faces without area. No ray meets them. */
    this.flatFaces = 0;
    /** @type {Bounds3 | null} */
    this.bounds = null;
    this.#measure();
  }

  /** The three corners of a face. @param {number} face @returns {[Point3, Point3, Point3]} */
  corners(face) {
    const corner = (/** @type {number} */ k) => {
      const v = 3 * this.faces[3 * face + k];
      return /** @type {Point3} */ ([this.vertices[v], this.vertices[v + 1], this.vertices[v + 2]]);
    };
    return [corner(0), corner(1), corner(2)];
  }

  /** Whether there is such a face, with three vertices. @param {number} face */
  hasFace(face) {
    if (!(face >= 0 && face < this.faceCount)) return false;
    const count = this.vertices.length / 3;
    return [0, 1, 2].every((k) => this.faces[3 * face + k] < count);
  }

  /** The normal of a face, not of unit length. @param {number} face @returns {Point3} */
  normal(face) {
    const [a, b, c] = this.corners(face);
    return vecCross(vecSub(b, a), vecSub(c, a));
  }

  /** The longest side of a face, metres. @param {number} face */
  longestSide(face) {
    const [a, b, c] = this.corners(face);
    return Math.max(vecLength(vecSub(b, a)), vecLength(vecSub(c, b)), vecLength(vecSub(a, c)));
  }

  /**
   * Where a ray meets the plane of a face: the multiple t of its direction, or NaN if it is parallel. These
   * are the operations of the page model, so that the range is the recorded one before rounding.
   * @param {number} face
   * @param {{origin: Point3, direction: Point3}} ray
   */
  planeHit(face, ray) {
    const [a] = this.corners(face);
    const n = this.normal(face);
    return vecDot(n, vecSub(a, ray.origin)) / vecDot(n, ray.direction);
  }

  #measure() {
    const { vertices, faces, normals } = this;
    const vertexCount = Math.floor(vertices.length / 3);
    const low = [Infinity, Infinity, Infinity];
    const high = [-Infinity, -Infinity, -Infinity];
    for (let face = 0; face < this.faceCount; face++) {
      const ia = faces[3 * face];
      const ib = faces[3 * face + 1];
      const ic = faces[3 * face + 2];
      if (!(ia < vertexCount && ib < vertexCount && ic < vertexCount)) {
        this.brokenFaces += 1;
        normals[4 * face + 3] = -1;
        continue;
      }
      const ax = vertices[3 * ia];
      const ay = vertices[3 * ia + 1];
      const az = vertices[3 * ia + 2];
      const bx = vertices[3 * ib];
      const by = vertices[3 * ib + 1];
      const bz = vertices[3 * ib + 2];
      const cx = vertices[3 * ic];
      const cy = vertices[3 * ic + 1];
      const cz = vertices[3 * ic + 2];
      const ux = bx - ax;
      const uy = by - ay;
      const uz = bz - az;
      const vx = cx - ax;
      const vy = cy - ay;
      const vz = cz - az;
      const nx = uy * vz - vy * uz;
      const ny = uz * vx - vz * ux;
      const nz = ux * vy - vx * uy;
      const length = Math.sqrt(nx * nx + ny * ny + nz * nz);
      if (!Number.isFinite(length)) {
        this.brokenFaces += 1;
        normals[4 * face + 3] = -1;
        continue;
      }
      if (length > 0) {
        normals[4 * face] = Math.round((127 * nx) / length);
        normals[4 * face + 1] = Math.round((127 * ny) / length);
        normals[4 * face + 2] = Math.round((127 * nz) / length);
      } else {
        this.flatFaces += 1;
        normals[4 * face + 2] = 127;
      }
      if (ax < low[0]) low[0] = ax;
      if (bx < low[0]) low[0] = bx;
      if (cx < low[0]) low[0] = cx;
      if (ax > high[0]) high[0] = ax;
      if (bx > high[0]) high[0] = bx;
      if (cx > high[0]) high[0] = cx;
      if (ay < low[1]) low[1] = ay;
      if (by < low[1]) low[1] = by;
      if (cy < low[1]) low[1] = cy;
      if (ay > high[1]) high[1] = ay;
      if (by > high[1]) high[1] = by;
      if (cy > high[1]) high[1] = cy;
      if (az < low[2]) low[2] = az;
      if (bz < low[2]) low[2] = bz;
      if (cz < low[2]) low[2] = cz;
      if (az > high[2]) high[2] = az;
      if (bz > high[2]) high[2] = bz;
      if (cz > high[2]) high[2] = cz;
    }
    if (low[0] <= high[0]) {
      this.bounds = { low: /** @type {Point3} */ (low), high: /** @type {Point3} */ (high) };
    }
  }
}

/**
 * An order of vertices in which every face has a last vertex of its own. The graphics processor takes the
 * colour and the normal of a face from that vertex. A vertex that is taken already is copied.
 *
 * `source[k]` is the vertex of the mesh that drawn vertex k is; `owner[k]` is the face whose last vertex it
 * is, or 4294967295.
 * @param {Terrain} terrain
 * @returns {{indices: Uint32Array, source: Uint32Array, owner: Uint32Array, count: number}}
 */
export function orderForDrawing(terrain) {
  const { faces, faceCount, normals } = terrain;
  const vertexCount = Math.floor(terrain.vertices.length / 3);
  const source = new Uint32Array(vertexCount + faceCount);
  const owner = new Uint32Array(vertexCount + faceCount).fill(4294967295);
  for (let vertex = 0; vertex < vertexCount; vertex++) source[vertex] = vertex;
  let count = vertexCount;
  const indices = new Uint32Array(3 * (faceCount - terrain.brokenFaces));
  let at = 0;
  for (let face = 0; face < faceCount; face++) {
    if (normals[4 * face + 3] < 0) continue;
    const a = faces[3 * face];
    const b = faces[3 * face + 1];
    const c = faces[3 * face + 2];
    // Turning the three corners about keeps their sense, and so the front.
    if (owner[c] === 4294967295) {
      owner[c] = face;
      indices[at] = a;
      indices[at + 1] = b;
      indices[at + 2] = c;
    } else if (owner[a] === 4294967295) {
      owner[a] = face;
      indices[at] = b;
      indices[at + 1] = c;
      indices[at + 2] = a;
    } else if (owner[b] === 4294967295) {
      owner[b] = face;
      indices[at] = c;
      indices[at + 1] = a;
      indices[at + 2] = b;
    } else {
      source[count] = c;
      owner[count] = face;
      indices[at] = a;
      indices[at + 1] = b;
      indices[at + 2] = count;
      count += 1;
    }
    at += 3;
  }
  return { indices, source, owner, count };
}
