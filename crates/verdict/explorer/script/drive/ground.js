// The true ground: its height under a place and the first face on a ray, by a grid over the faces.

import { hitOfFace } from '../view3d/search.js';

/** @typedef {import('../view3d/vector.js').Point3} Point3 */

/** Room about the box of a face for rounding, metres. */
const GROUND_PADDING = 1e-6;

/** Cells of the grid along a side, at most. */
const GROUND_SIDE = 2048;

/** Entries of the grid for each face, on average at most. Many large faces over one another: the cells grow. */
const GROUND_ENTRIES = 32;

export class DriveGround {
  /** @param {Float32Array} vertices scene frame, metres @param {Uint32Array} faces */
  constructor(vertices, faces) {
    this.vertices = vertices;
    this.faces = faces;
    this.faceCount = Math.floor(faces.length / 3);
    [this.left, this.bottom, this.right, this.top] = [Infinity, Infinity, -Infinity, -Infinity];
    const boxes = this.#boxes();
    const extent = Math.max(this.right - this.left, this.top - this.bottom, 0);
    const area = Math.max(0, (this.right - this.left) * (this.top - this.bottom));
    const oneFaceEach = Math.sqrt(area / Math.max(1, this.faceCount)) || 0;
    this.cell = Math.max(oneFaceEach, extent / GROUND_SIDE, GROUND_PADDING);
    while (this.#entries(boxes) > GROUND_ENTRIES * this.faceCount + 4) {
      this.cell *= 2;
    }
    this.columns = this.faceCount > 0 ? Math.floor((this.right - this.left) / this.cell) + 1 : 1;
    this.rows = this.faceCount > 0 ? Math.floor((this.top - this.bottom) / this.cell) + 1 : 1;
    this.starts = new Uint32Array(this.columns * this.rows + 1);
    this.list = this.#fill(boxes);
    /** Number of the last ray that tested each face: a face may lie in many cells. */
    this.tested = new Uint32Array(this.faceCount);
    this.rays = 0;
  }

  /** Box of each face: left, bottom, right, top. Broken faces have NaN. */
  #boxes() {
    const { vertices, faces } = this;
    const boxes = new Float64Array(4 * this.faceCount);
    for (let face = 0; face < this.faceCount; face += 1) {
      const [a, b, c] = [3 * faces[3 * face], 3 * faces[3 * face + 1], 3 * faces[3 * face + 2]];
      const left = Math.min(vertices[a], vertices[b], vertices[c]) - GROUND_PADDING;
      const bottom = Math.min(vertices[a + 1], vertices[b + 1], vertices[c + 1]) - GROUND_PADDING;
      const right = Math.max(vertices[a], vertices[b], vertices[c]) + GROUND_PADDING;
      const top = Math.max(vertices[a + 1], vertices[b + 1], vertices[c + 1]) + GROUND_PADDING;
      boxes.set([left, bottom, right, top], 4 * face);
      if (Number.isFinite(right - left + top - bottom)) {
        this.left = Math.min(this.left, left);
        this.bottom = Math.min(this.bottom, bottom);
        this.right = Math.max(this.right, right);
        this.top = Math.max(this.top, top);
      }
    }
    return boxes;
  }

  /** Entries of all faces with the present cell, at most. @param {Float64Array} boxes */
  #entries(boxes) {
    let sum = 0;
    for (let at = 0; at < boxes.length; at += 4) {
      const across = Math.floor((boxes[at + 2] - boxes[at]) / this.cell) + 2;
      const down = Math.floor((boxes[at + 3] - boxes[at + 1]) / this.cell) + 2;
      sum += across * down || 0;
    }
    return sum;
  }

  /** @param {number} place @param {number} from @param {number} count */
  #along(place, from, count) {
    return Math.max(0, Math.min(count - 1, Math.floor((place - from) / this.cell)));
  }

  /** The list of faces, cell by cell. Two passes: count, then fill in. @param {Float64Array} boxes */
  #fill(boxes) {
    const { starts, columns, rows } = this;
    const visit = (/** @type {(cell: number, face: number) => void} */ enter) => {
      for (let face = 0; face < this.faceCount; face += 1) {
        const [left, bottom, right, top] = boxes.subarray(4 * face, 4 * face + 4);
        if (!Number.isFinite(right - left + top - bottom)) { continue; }
        const [from, to] = [this.#along(left, this.left, columns), this.#along(right, this.left, columns)];
        const last = this.#along(top, this.bottom, rows);
        for (let row = this.#along(bottom, this.bottom, rows); row <= last; row += 1) {
          for (let column = from; column <= to; column += 1) {
            enter(row * columns + column, face);
          }
        }
      }
    };
    visit((cell) => { starts[cell + 1] += 1; });
    for (let cell = 0; cell < columns * rows; cell += 1) {
      starts[cell + 1] += starts[cell];
    }
    const next = starts.slice();
    const list = new Uint32Array(starts[columns * rows]);
    visit((cell, face) => { list[next[cell]] = face; next[cell] += 1; });
    return list;
  }

  /**
   * Height of the highest face that looks up, above a place of the plan; NaN where there is none. These are the
   * rules by which the vehicle stands on the ground.
   * @param {number} x @param {number} y scene frame, metres
   */
  heightAt(x, y) {
    if (!(x >= this.left && x <= this.right && y >= this.bottom && y <= this.top)) {
      return NaN;
    }
    const { vertices, faces, starts, list } = this;
    const cell = this.#along(y, this.bottom, this.rows) * this.columns + this.#along(x, this.left, this.columns);
    let highest = NaN;
    for (let at = starts[cell]; at < starts[cell + 1]; at += 1) {
      const face = 3 * list[at];
      const [a, b, c] = [3 * faces[face], 3 * faces[face + 1], 3 * faces[face + 2]];
      const [ax, ay] = [vertices[a] - x, vertices[a + 1] - y];
      const [bx, by] = [vertices[b] - x, vertices[b + 1] - y];
      const [cx, cy] = [vertices[c] - x, vertices[c + 1] - y];
      // Twice the areas of the triangles that the place forms with the sides.
      const ofA = bx * cy - by * cx;
      const ofB = cx * ay - cy * ax;
      const ofC = ax * by - ay * bx;
      const sum = ofA + ofB + ofC;
      if (!(ofA >= 0 && ofB >= 0 && ofC >= 0 && sum > 0)) { continue; }
      const height = vertices[a + 2]
        + ((vertices[b + 2] - vertices[a + 2]) * ofB + (vertices[c + 2] - vertices[a + 2]) * ofC) / sum;
      if (!(height <= highest)) { highest = height; }
    }
    return highest;
  }

  /**
   * The first face on a ray, as a multiple of its direction; `farthest` if there is none before.
   * @param {Point3} origin @param {Point3} direction @param {number} farthest multiple of the direction
   */
  rayHit(origin, direction, farthest) {
    this.rays += 1;
    let [from, to] = [0, farthest];
    // The part of the ray over the grid.
    const sides = [
      [origin[0], direction[0], this.left, this.right], [origin[1], direction[1], this.bottom, this.top],
    ];
    for (const [start, speed, low, high] of sides) {
      if (speed === 0) {
        if (start < low || start > high) { return farthest; }
        continue;
      }
      const [one, other] = [(low - start) / speed, (high - start) / speed];
      from = Math.max(from, Math.min(one, other));
      to = Math.min(to, Math.max(one, other));
    }
    if (!(from <= to)) {
      return farthest;
    }
    let column = this.#along(origin[0] + direction[0] * from, this.left, this.columns);
    let row = this.#along(origin[1] + direction[1] * from, this.bottom, this.rows);
    const [stepX, stepY] = [Math.sign(direction[0]), Math.sign(direction[1])];
    let best = farthest;
    for (let visited = 0; visited < 2 * (this.columns + this.rows); visited += 1) {
      best = this.#nearestIn(row * this.columns + column, origin, direction, best);
      const borderX = this.left + (column + (stepX > 0 ? 1 : 0)) * this.cell;
      const borderY = this.bottom + (row + (stepY > 0 ? 1 : 0)) * this.cell;
      const nextX = stepX === 0 ? Infinity : (borderX - origin[0]) / direction[0];
      const nextY = stepY === 0 ? Infinity : (borderY - origin[1]) / direction[1];
      const next = Math.min(nextX, nextY);
      if (best <= next || next > to) { break; }
      if (nextX <= nextY) { column += stepX; } else { row += stepY; }
      if (column < 0 || row < 0 || column >= this.columns || row >= this.rows) { break; }
    }
    return best;
  }

  /** @param {number} cell @param {Point3} origin @param {Point3} direction @param {number} best */
  #nearestIn(cell, origin, direction, best) {
    const { list, starts } = this;
    let nearest = best;
    for (let at = starts[cell]; at < starts[cell + 1]; at += 1) {
      const face = list[at];
      if (this.tested[face] === this.rays) { continue; }
      this.tested[face] = this.rays;
      const t = hitOfFace(this, { origin, direction }, face, false);
      if (t > 0 && t < nearest) { nearest = t; }
    }
    return nearest;
  }
}
