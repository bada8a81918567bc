// The eye of the picture: where it stands, its lens, and the projection of points in double precision.

import { vecAlong, vecCross, vecDot, vecLength, vecScale, vecSub, vecUnit } from './vector.js';

/** @typedef {import('./vector.js').Point3} Point3 */
/** @typedef {import('./terrain.js').Bounds3} Bounds3 */
/** @typedef {{right: Point3, down: Point3, forward: Point3}} Axes3 */
/**
 * A lens: an angle, fitted to the shorter side of the canvas; or the image of a sensor of `width` x `height`
 * cells, fitted into the canvas, with its cells as squares. `u` and `v` are the place of the image in the
 * middle of the canvas; a zoom of 1 shows the whole image.
 * @typedef {{kind: 'angle', angle: number}
 *   | {kind: 'image', width: number, height: number, focal: [number, number], centre: [number, number],
 *      zoom: number, u: number, v: number}} Lens
 */
/**
 * A pose of the eye. `focus` is the point that drags turn about.
 * @typedef {{eye: Point3, axes: Axes3, lens: Lens, focus: Point3, nearest: number}} EyePose
 */

/** Angle of view of the free eye: 40 degrees. */
const FREE_ANGLE = (40 * Math.PI) / 180;

/** The lens of the free eye. @returns {Lens} */
function freeLens() {
  return { kind: 'angle', angle: FREE_ANGLE };
}

/**
 * The pose that looks at `focus` from a distance. `yaw` turns left about z from the x axis; `pitch` is
 * downward.
 * @param {Point3} focus
 * @param {number} distance metres
 * @param {number} yaw radians
 * @param {number} pitch radians
 * @returns {EyePose}
 */
export function orbitPose(focus, distance, yaw, pitch) {
  /** @type {Point3} */
  const forward = [Math.cos(pitch) * Math.cos(yaw), Math.cos(pitch) * Math.sin(yaw), -Math.sin(pitch)];
  /** @type {Point3} */
  const right = [Math.sin(yaw), -Math.cos(yaw), 0];
  const down = vecCross(forward, right);
  const eye = vecAlong(focus, forward, -distance);
  return { eye, axes: { right, down, forward }, lens: freeLens(), focus, nearest: 0 };
}

/** Yaw, pitch and distance of a pose. @param {EyePose} pose */
export function orbitOfPose(pose) {
  const { forward, right } = pose.axes;
  const pitch = Math.asin(Math.max(-1, Math.min(1, -forward[2])));
  // The axis to the right tells the yaw also where the eye looks straight down.
  const yaw = Math.atan2(right[0], -right[1]);
  return { yaw, pitch, distance: Math.max(vecLength(vecSub(pose.focus, pose.eye)), 1e-9) };
}

/**
 * A pose, part of the way from one to another.
 * @param {EyePose} a
 * @param {EyePose} b
 * @param {number} share
 * @returns {EyePose}
 */
export function poseBetween(a, b, share) {
  const mixed = (/** @type {Point3} */ x, /** @type {Point3} */ y) =>
    /** @type {Point3} */ ([0, 1, 2].map((k) => x[k] + (y[k] - x[k]) * share));
  const forward = vecUnit(mixed(a.axes.forward, b.axes.forward));
  const rough = mixed(a.axes.right, b.axes.right);
  const right = vecUnit(vecAlong(rough, forward, -vecDot(rough, forward)));
  return {
    eye: mixed(a.eye, b.eye),
    axes: { right, down: vecCross(forward, right), forward },
    lens: share < 0.5 ? a.lens : b.lens,
    focus: mixed(a.focus, b.focus),
    nearest: 0,
  };
}

/**
 * The projection of one frame. Points are projected in double precision; the terrain's matrix is rounded
 * last.
 */
export class ViewCamera {
  constructor() {
    /** @type {EyePose} */
    this.pose = orbitPose([0, 0, 0], 10, 0, 0.5);
    /** Size of the canvas, CSS pixels. */
    this.width = 1;
    this.height = 1;
    this.near = 0.1;
    this.far = 100;
    // x = scaleX * right / forward + shiftX, in -1 to 1 over the canvas; y likewise, downward.
    this.scaleX = 1;
    this.scaleY = 1;
    this.shiftX = 0;
    this.shiftY = 0;
  }

  /** CSS pixels of one cell of the image that the lens shows, or 0. */
  get cellSize() {
    const { lens } = this.pose;
    if (lens.kind !== 'image') return 0;
    return Math.min(this.width / lens.width, this.height / lens.height) * lens.zoom;
  }

  /**
   * Sets the lens for the size of the canvas, and the nearest and farthest depth for what is to be seen.
   * @param {number} width CSS pixels
   * @param {number} height CSS pixels
   * @param {Bounds3} bounds of everything
   */
  fit(width, height, bounds) {
    this.width = Math.max(width, 1);
    this.height = Math.max(height, 1);
    const { lens } = this.pose;
    if (lens.kind === 'angle') {
      const scale = 1 / Math.tan(lens.angle / 2);
      const shorter = Math.min(this.width, this.height);
      this.scaleX = (scale * shorter) / this.width;
      this.scaleY = (scale * shorter) / this.height;
      this.shiftX = 0;
      this.shiftY = 0;
    } else {
      const size = this.cellSize;
      this.scaleX = (2 * size * lens.focal[0]) / this.width;
      this.scaleY = (2 * size * lens.focal[1]) / this.height;
      this.shiftX = (2 * size * (lens.centre[0] - lens.u)) / this.width;
      this.shiftY = (2 * size * (lens.centre[1] - lens.v)) / this.height;
    }
    this.#fitDepths(bounds);
  }

  /** @param {Bounds3} bounds */
  #fitDepths(bounds) {
    const { eye, axes, focus, nearest } = this.pose;
    let low = Infinity;
    let high = 0;
    for (let corner = 0; corner < 8; corner++) {
      /** @type {Point3} */
      const point = [
        corner & 1 ? bounds.high[0] : bounds.low[0],
        corner & 2 ? bounds.high[1] : bounds.low[1],
        corner & 4 ? bounds.high[2] : bounds.low[2],
      ];
      const depth = vecDot(axes.forward, vecSub(point, eye));
      low = Math.min(low, depth);
      high = Math.max(high, depth);
    }
    const reach = vecLength(vecSub(focus, eye));
    this.far = Math.max(high * 1.001, reach * 2, 1e-6);
    this.near =
      nearest > 0 ? Math.min(nearest, this.far / 2) : Math.max(low * 0.999, reach * 0.02, this.far * 1e-9);
    this.near = Math.min(this.near, this.far * 0.5);
  }

  /** Whether depths are so unlike that 24 bits need the logarithm. */
  get isDeep() {
    return this.far / this.near > 3e4;
  }

  /**
   * A point in clip coordinates: x, y, z, w.
   * @param {Point3} point
   * @returns {[number, number, number, number]}
   */
  clip(point) {
    const { eye, axes } = this.pose;
    const dx = point[0] - eye[0];
    const dy = point[1] - eye[1];
    const dz = point[2] - eye[2];
    const { right, down, forward } = axes;
    const x = right[0] * dx + right[1] * dy + right[2] * dz;
    const y = down[0] * dx + down[1] * dy + down[2] * dz;
    const depth = forward[0] * dx + forward[1] * dy + forward[2] * dz;
    const span = this.far - this.near;
    const z = (depth * (this.far + this.near)) / span - (2 * this.far * this.near) / span;
    return [this.scaleX * x + this.shiftX * depth, -this.scaleY * y - this.shiftY * depth, z, depth];
  }

  /**
   * A point in CSS pixels of the canvas, from its upper left corner; null if it is not before the eye.
   * @param {Point3} point
   * @returns {[number, number] | null}
   */
  project(point) {
    const [x, y, , w] = this.clip(point);
    if (!(w > this.near * 0.999)) return null;
    return [((x / w + 1) / 2) * this.width, ((1 - y / w) / 2) * this.height];
  }

  /**
   * The direction, in the scene frame, of what is seen at a place of the canvas; its depth along the axis is
   * 1.
   * @param {number} x CSS pixels
   * @param {number} y CSS pixels
   * @returns {Point3}
   */
  directionAt(x, y) {
    const { right, down, forward } = this.pose.axes;
    const across = ((2 * x) / this.width - 1 - this.shiftX) / this.scaleX;
    const below = ((2 * y) / this.height - 1 - this.shiftY) / this.scaleY;
    return vecAlong(vecAlong(forward, right, across), down, below);
  }

  /** Metres per CSS pixel at the depth of the focus. */
  get metresPerPixel() {
    const { eye, axes, focus } = this.pose;
    const depth = Math.max(vecDot(axes.forward, vecSub(focus, eye)), 0);
    return (2 * depth) / (this.scaleX * this.width);
  }

  /**
   * What the terrain's shader needs. It subtracts `eyeHigh`, which is exact for vertices near the eye, and
   * turns the difference by `matrix`. The rest of the eye's position is in `shift`, which was turned in
   * double precision.
   * @returns {{matrix: Float32Array, shift: Float32Array, eyeHigh: Float32Array}}
   */
  forShader() {
    const { eye, axes } = this.pose;
    const { right, down, forward } = axes;
    const eyeHigh = new Float32Array(eye);
    const eyeLow = vecSub(eye, [eyeHigh[0], eyeHigh[1], eyeHigh[2]]);
    const span = this.far - this.near;
    const slope = (this.far + this.near) / span;
    /** @type {Point3[]} rows of the matrix that act on a difference of positions */
    const rows = [
      vecAlong(vecScale(right, this.scaleX), forward, this.shiftX),
      vecAlong(vecScale(down, -this.scaleY), forward, -this.shiftY),
      vecScale(forward, slope),
      forward,
    ];
    const matrix = new Float32Array(16);
    const shift = new Float32Array(4);
    for (let row = 0; row < 4; row++) {
      for (let column = 0; column < 3; column++) matrix[4 * column + row] = rows[row][column];
      const constant = row === 2 ? (-2 * this.far * this.near) / span : 0;
      shift[row] = constant - vecDot(rows[row], eyeLow);
    }
    return { matrix, shift, eyeHigh };
  }
}
