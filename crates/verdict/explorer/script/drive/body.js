// The vehicle as solid faces: body, wheels, and posts up to its sensors.

import { packedHex } from '../panel/colour.js';

/** @typedef {import('../view3d/vector.js').Point3} Point3 */
/** @typedef {import('./model.js').DriveVehicle} DriveVehicle */
/** @typedef {import('./looks.js').DriveTheme} DriveTheme */
/** @typedef {import('./solid.js').SolidMesh} SolidMesh */

/** Flat pieces of a wheel's rim. */
const RIM_PIECES = 20;

/** A growing list of faces. */
class FaceList {
  /** @param {(local: Point3) => Point3} place from the vehicle frame to the scene frame */
  constructor(place) {
    this.place = place;
    /** @type {number[]} */
    this.positions = [];
    /** @type {number[]} */
    this.colours = [];
  }

  /** A flat convex face. @param {Point3[]} corners vehicle frame @param {number} colour packed */
  face(corners, colour) {
    const placed = corners.map(this.place);
    for (let k = 2; k < placed.length; k += 1) {
      this.positions.push(...placed[0], ...placed[k - 1], ...placed[k]);
      this.colours.push(colour, colour, colour);
    }
  }

  /** @param {Point3} low @param {Point3} high @param {number} colour packed */
  box(low, high, colour) {
    const corner = (/** @type {number} */ k) => /** @type {Point3} */ ([
      k & 1 ? high[0] : low[0], k & 2 ? high[1] : low[1], k & 4 ? high[2] : low[2],
    ]);
    for (const side of [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]]) {
      this.face(side.map(corner), colour);
    }
  }

  /** @param {number} x of the hub @param {number} y @param {number} radius @param {number} width
   * @param {number} colour @param {number} hub packed colours */
  wheel(x, y, radius, width, colour, hub) {
    const rim = (/** @type {number} */ k, /** @type {number} */ side, /** @type {number} */ size) => {
      const angle = 2 * Math.PI * k / RIM_PIECES;
      return /** @type {Point3} */ ([
        x + Math.cos(angle) * radius * size, y + side * width / 2, radius + Math.sin(angle) * radius * size,
      ]);
    };
    for (const side of [-1, 1]) {
      this.face(Array.from({ length: RIM_PIECES }, (_, k) => rim(k, side, 1)), colour);
      this.face(Array.from({ length: RIM_PIECES }, (_, k) => rim(k, side * 1.04, 0.45)), hub);
    }
    for (let k = 0; k < RIM_PIECES; k += 1) {
      this.face([rim(k, -1, 1), rim(k + 1, -1, 1), rim(k + 1, 1, 1), rim(k, 1, 1)], colour);
    }
  }
}

/**
 * @param {DriveVehicle} vehicle @param {Point3[]} sensors places in the vehicle frame
 * @param {(local: Point3) => Point3} place @param {DriveTheme} theme
 * @returns {SolidMesh}
 */
export function vehicleBody(vehicle, sensors, place, theme) {
  const { wheelbase, track, wheel_radius: radius, wheel_width: width, clearance } = vehicle;
  const list = new FaceList(place);
  const [body, dark, light] = [packedHex(theme.body), packedHex('#3a3c40'), packedHex('#a9a69e')];
  const halfWidth = Math.max(0.15 * track, track / 2 - width / 2 - 0.04);
  const top = clearance + 0.8 * radius;
  const halfLength = wheelbase / 2 + 0.5 * radius;
  list.box([-halfLength, -halfWidth, clearance], [halfLength, halfWidth, top], body);
  for (const x of [-wheelbase / 2, wheelbase / 2]) {
    list.box([x - 0.04, -track / 2, radius - 0.04], [x + 0.04, track / 2, radius + 0.04], dark);
    for (const y of [-track / 2, track / 2]) {
      list.wheel(x, y, radius, width, dark, light);
    }
  }
  // Sensors above one another share a post.
  /** @type {Map<string, Point3>} */
  const posts = new Map();
  for (const [x, y, z] of sensors) {
    const key = `${x.toFixed(2)}/${y.toFixed(2)}`;
    const isOver = Math.abs(x) < wheelbase / 2 + radius && Math.abs(y) < track / 2;
    if (isOver && z > (posts.get(key)?.[2] ?? top)) { posts.set(key, [x, y, z]); }
  }
  for (const [x, y, z] of posts.values()) {
    list.box([x - 0.16, y - 0.025, top], [x - 0.11, y + 0.025, z + 0.02], light);
  }
  const count = list.colours.length;
  return {
    positions: Float32Array.from(list.positions), colours: Uint32Array.from(list.colours),
    indices: Uint32Array.from({ length: count }, (_, k) => k),
  };
}
