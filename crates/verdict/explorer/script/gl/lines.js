// Lines and translucent areas over the terrain: clipped and projected in double precision, drawn by WebGL2.
//
// A close-up may show micrometres of a line of many metres. So each line is clipped to what is seen before
// its numbers are rounded to single precision.

import { DepthProgram, GL_WRITE_DEPTH } from './program.js';

/** @typedef {import('../view3d/vector.js').Point3} Point3 */
/** @typedef {import('../view3d/camera.js').ViewCamera} ViewCamera */
/** @typedef {[number, number, number, number]} Rgba numbers of 0 to 1, not multiplied by the last */
/**
 * @typedef {object} LineLook
 * @property {number} width CSS pixels
 * @property {[number, number]} [dash] lengths of a dash and of a gap, CSS pixels
 * @property {boolean} [arrow] whether an arrow head stands at its middle
 * @property {boolean} [ghost] whether it shines through the terrain, faintly
 */

const LINES_VERTEX = `
layout(location = 0) in vec4 place; // x, y, z of -1 to 1; 1 / depth
layout(location = 1) in vec2 side; // distance from the middle of the line, half of its width, device pixels
layout(location = 2) in vec4 colour;
uniform vec2 pull; // towards the eye, so that lines on faces are seen: factor of 1 / depth, constant
out vec2 across;
out vec4 paint;
out float inverseDepth;
void main() {
  gl_Position = vec4(place.xy, place.z - pull.x * place.w - pull.y, 1.0);
  across = side;
  paint = colour;
  inverseDepth = place.w;
}
`;

const LINES_FRAGMENT = `
in vec2 across;
in vec4 paint;
in float inverseDepth;
uniform float strength;
out vec4 result;
${GL_WRITE_DEPTH}
void main() {
  float cover = clamp(across.y - abs(across.x) + 0.5, 0.0, 1.0);
  result = vec4(paint.rgb, paint.a * cover * strength);
  writeDepth(1.0 / inverseDepth);
}
`;

const NUMBERS_PER_VERTEX = 10;

/** A growing list of triangles. */
class TriangleList {
  constructor() {
    this.numbers = new Float32Array(4096 * NUMBERS_PER_VERTEX);
    this.vertices = 0;
  }

  /**
   * @param {number} x
   * @param {number} y
   * @param {number} z
   * @param {number} inverse 1 / depth
   * @param {number} side
   * @param {number} half
   * @param {Rgba} colour
   */
  add(x, y, z, inverse, side, half, colour) {
    let at = this.vertices * NUMBERS_PER_VERTEX;
    if (at + NUMBERS_PER_VERTEX > this.numbers.length) {
      const larger = new Float32Array(2 * this.numbers.length);
      larger.set(this.numbers);
      this.numbers = larger;
    }
    const { numbers } = this;
    numbers[at++] = x;
    numbers[at++] = y;
    numbers[at++] = z;
    numbers[at++] = inverse;
    numbers[at++] = side;
    numbers[at++] = half;
    numbers[at++] = colour[0];
    numbers[at++] = colour[1];
    numbers[at++] = colour[2];
    numbers[at] = colour[3];
    this.vertices += 1;
  }
}

/** Lines and areas of one frame. */
export class StrokeDrawing {
  /** @param {WebGL2RenderingContext} gl */
  constructor(gl) {
    this.gl = gl;
    this.program = new DepthProgram(gl, LINES_VERTEX, LINES_FRAGMENT);
    this.array = gl.createVertexArray();
    this.buffer = gl.createBuffer();
    gl.bindVertexArray(this.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
    const stride = 4 * NUMBERS_PER_VERTEX;
    [
      [0, 4, 0],
      [1, 2, 16],
      [2, 4, 24],
    ].forEach(([index, size, offset]) => {
      gl.enableVertexAttribArray(index);
      gl.vertexAttribPointer(index, size, gl.FLOAT, false, stride, offset);
    });
    gl.bindVertexArray(null);
    this.areas = new TriangleList();
    this.lines = new TriangleList();
    this.ghosts = new TriangleList();
    /** @type {ViewCamera | null} */
    this.camera = null;
    this.pixelRatio = 1;
  }

  /** Starts a frame. @param {ViewCamera} camera @param {number} pixelRatio device pixels per CSS pixel */
  begin(camera, pixelRatio) {
    this.camera = camera;
    this.pixelRatio = pixelRatio;
    this.areas.vertices = 0;
    this.lines.vertices = 0;
    this.ghosts.vertices = 0;
  }

  /** @param {Point3} from @param {Point3} to @param {Rgba} colour @param {LineLook} look */
  line(from, to, colour, look) {
    if (!this.camera) return;
    const clipped = clipLine(this.camera.clip(from), this.camera.clip(to));
    if (!clipped) return;
    const list = look.ghost ? this.ghosts : this.lines;
    const [a, b] = clipped.map(([x, y, z, w]) => ({ x: x / w, y: y / w, z: z / w, inverse: 1 / w }));
    // Half of the canvas in device pixels: the unit of x and y.
    const halfWidth = (this.camera.width * this.pixelRatio) / 2;
    const halfHeight = (this.camera.height * this.pixelRatio) / 2;
    const dx = (b.x - a.x) * halfWidth;
    const dy = (b.y - a.y) * halfHeight;
    const length = Math.hypot(dx, dy);
    if (!(length > 1e-6)) return;
    const half = (look.width * this.pixelRatio) / 2;
    const reach = half + 1;
    const nx = ((-dy / length) * reach) / halfWidth;
    const ny = ((dx / length) * reach) / halfHeight;
    /** @param {number} share of the line @param {number} sign way across it, in units of its reach */
    const corner = (share, sign, side = reach * sign, halfOfSide = half) => {
      list.add(
        a.x + (b.x - a.x) * share + nx * sign,
        a.y + (b.y - a.y) * share + ny * sign,
        a.z + (b.z - a.z) * share,
        a.inverse + (b.inverse - a.inverse) * share,
        side,
        halfOfSide,
        colour,
      );
    };
    const piece = (/** @type {number} */ start, /** @type {number} */ end) => {
      corner(start, -1);
      corner(start, 1);
      corner(end, 1);
      corner(start, -1);
      corner(end, 1);
      corner(end, -1);
    };
    if (look.dash) {
      const [dash, gap] = look.dash.map((pixels) => pixels * this.pixelRatio);
      const period = Math.max(dash + gap, length / 2000);
      for (let at = 0; at < length; at += period)
        piece(at / length, Math.min(at + (period * dash) / (dash + gap), length) / length);
    } else {
      piece(0, 1);
    }
    if (look.arrow && length > 40 * this.pixelRatio) {
      const size = (5 + 2 * look.width) * this.pixelRatio;
      const tip = 0.5 + size / length;
      const wing = (size * 0.6) / reach;
      corner(tip, 0, 0, 1e4);
      corner(0.5 - size / length, wing, 0, 1e4);
      corner(0.5 - size / length, -wing, 0, 1e4);
    }
  }

  /** A flat convex area. @param {Point3[]} points @param {Rgba} colour */
  area(points, colour) {
    const { camera } = this;
    if (!camera) return;
    const clipped = clipArea(points.map((point) => camera.clip(point)));
    const add = (/** @type {number[]} */ [x, y, z, w]) => {
      this.areas.add(x / w, y / w, z / w, 1 / w, 0, 1e4, colour);
    };
    for (let k = 2; k < clipped.length; k++) {
      add(clipped[0]);
      add(clipped[k - 1]);
      add(clipped[k]);
    }
  }

  /**
   * Draws what was added since `begin`, behind nothing but the terrain.
   * @param {number} slack share of the depth by which the terrain may be drawn too near to the eye
   */
  draw(slack) {
    const { gl, camera } = this;
    if (!camera) return;
    const program = this.program.use(camera);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    gl.disable(gl.CULL_FACE);
    gl.enable(gl.DEPTH_TEST);
    gl.depthMask(false);
    gl.bindVertexArray(this.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
    this.#drawList(program, this.areas, gl.LEQUAL, 1, 3e-4 + slack);
    this.#drawList(program, this.ghosts, gl.GREATER, 0.28, 1.5e-3 + slack);
    this.#drawList(program, this.lines, gl.LEQUAL, 1, 1.5e-3 + slack);
    this.#drawList(program, this.ghosts, gl.LEQUAL, 1, 1.5e-3 + slack);
    gl.bindVertexArray(null);
    gl.depthMask(true);
  }

  /**
   * @param {import('./program.js').GlProgram} program
   * @param {TriangleList} list
   * @param {number} compare
   * @param {number} strength
   * @param {number} pull share of the depth by which it is drawn nearer to the eye
   */
  #drawList(program, list, compare, strength, pull) {
    const { gl, camera } = this;
    if (list.vertices === 0 || !camera) return;
    gl.depthFunc(compare);
    program.set('strength', strength);
    program.setPull(camera, pull);
    gl.bufferData(
      gl.ARRAY_BUFFER,
      list.numbers.subarray(0, list.vertices * NUMBERS_PER_VERTEX),
      gl.STREAM_DRAW,
    );
    gl.drawArrays(gl.TRIANGLES, 0, list.vertices);
  }

  dispose() {
    this.gl.deleteBuffer(this.buffer);
    this.gl.deleteVertexArray(this.array);
    this.program.dispose();
  }
}

/**
 * Distances of a clip point from the sides of what is seen; the sides lie a little outside of the canvas.
 * @param {number[]} point x, y, z, w
 * @returns {number[]}
 */
function clipDistances([x, y, z, w]) {
  return [z + w, w - z, 1.1 * w - x, 1.1 * w + x, 1.1 * w - y, 1.1 * w + y];
}

/**
 * The part of a line that is seen.
 * @param {number[]} a
 * @param {number[]} b
 * @returns {[number[], number[]] | null}
 */
function clipLine(a, b) {
  let start = 0;
  let end = 1;
  const da = clipDistances(a);
  const db = clipDistances(b);
  for (let k = 0; k < da.length; k++) {
    if (!(da[k] >= 0) && !(db[k] >= 0)) return null;
    if (da[k] >= 0 && db[k] >= 0) continue;
    const share = da[k] / (da[k] - db[k]);
    if (da[k] < 0) start = Math.max(start, share);
    else end = Math.min(end, share);
  }
  if (start >= end) return null;
  const at = (/** @type {number} */ share) => a.map((value, k) => value + (b[k] - value) * share);
  return [start > 0 ? at(start) : a, end < 1 ? at(end) : b];
}

/** The part of a convex area that is seen. @param {number[][]} points @returns {number[][]} */
function clipArea(points) {
  let kept = points;
  for (let side = 0; side < 6 && kept.length > 2; side++) {
    const distances = kept.map((point) => clipDistances(point)[side]);
    if (distances.every((distance) => distance >= 0)) continue;
    /** @type {number[][]} */
    const next = [];
    for (let k = 0; k < kept.length; k++) {
      const l = (k + 1) % kept.length;
      if (distances[k] >= 0) next.push(kept[k]);
      if (distances[k] >= 0 !== distances[l] >= 0) {
        const share = distances[k] / (distances[k] - distances[l]);
        next.push(kept[k].map((value, axis) => value + (kept[l][axis] - value) * share));
      }
    }
    kept = next;
  }
  return kept.length > 2 ? kept : [];
}
