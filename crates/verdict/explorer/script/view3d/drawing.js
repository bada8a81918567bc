// A drawing in the scene: lines, areas, marks and labels by the names of their colours, before any
// projection.

/** @typedef {import('./vector.js').Point3} Point3 */
/** @typedef {import('./theme.js').ColourName} ColourName */
/** @typedef {import('../gl/lines.js').LineLook} LineLook */
/** @typedef {'circle' | 'square' | 'plus' | 'cross' | 'dot' | 'pixel' | 'ring'} MarkShape */
/**
 * @typedef {object} SceneLabel
 * @property {Point3} at
 * @property {string} text
 * @property {ColourName} colour
 * @property {number} priority the higher keeps its place; below 1 it goes away where there is no room
 * @property {boolean} [isTick] a number at a scale: without a frame, close to its place
 */

/** Lines, areas, marks and labels. */
export class SceneDrawing {
  constructor() {
    /** @type {{from: Point3, to: Point3, colour: ColourName, opacity: number, look: LineLook}[]} */
    this.lines = [];
    /** @type {{points: Point3[], colour: ColourName, opacity: number}[]} */
    this.areas = [];
    /** @type {{at: Point3, shape: MarkShape, colour: ColourName}[]} */
    this.marks = [];
    /** @type {SceneLabel[]} */
    this.labels = [];
  }

  /**
   * @param {Point3} from
   * @param {Point3} to
   * @param {ColourName} colour
   * @param {LineLook} look
   * @param {number} [opacity]
   */
  line(from, to, colour, look, opacity = 1) {
    this.lines.push({ from, to, colour, opacity, look });
  }

  /**
   * A line through points.
   * @param {Point3[]} points
   * @param {ColourName} colour
   * @param {LineLook} look
   * @param {number} [opacity]
   * @param {boolean} [isClosed]
   */
  path(points, colour, look, opacity = 1, isClosed = false) {
    for (let k = 1; k < points.length; k++) this.line(points[k - 1], points[k], colour, look, opacity);
    if (isClosed && points.length > 2) this.line(points[points.length - 1], points[0], colour, look, opacity);
  }

  /** @param {Point3[]} points @param {ColourName} colour @param {number} opacity */
  area(points, colour, opacity) {
    this.areas.push({ points, colour, opacity });
  }

  /** @param {Point3} at @param {MarkShape} shape @param {ColourName} colour */
  mark(at, shape, colour) {
    this.marks.push({ at, shape, colour });
  }

  /** @param {Point3} at @param {string} text @param {ColourName} colour @param {number} [priority] */
  label(at, text, colour, priority = 5) {
    this.labels.push({ at, text, colour, priority });
  }

  /**
   * A box between two opposite corners of a frame that `place` puts into the scene.
   * @param {Point3} low
   * @param {Point3} high
   * @param {(local: Point3) => Point3} place
   * @param {ColourName} colour
   */
  box(low, high, place, colour) {
    const corners = Array.from({ length: 8 }, (_, k) =>
      place([k & 1 ? high[0] : low[0], k & 2 ? high[1] : low[1], k & 4 ? high[2] : low[2]]),
    );
    const sides = [
      [0, 1, 3, 2],
      [4, 5, 7, 6],
      [0, 1, 5, 4],
      [2, 3, 7, 6],
      [0, 2, 6, 4],
      [1, 3, 7, 5],
    ];
    for (const side of sides) {
      const points = side.map((k) => corners[k]);
      this.area(points, colour, 0.35);
      this.path(points, colour, { width: 1.2 }, 0.9, true);
    }
  }
}
