// The geometry of a sensor: the rays of its cells (also between cells), and the place of a point on its
// image.

import { vecAdd, vecScale, vecSub, vecTurn, vecTurnBack } from './vector.js';

/** @typedef {import('./vector.js').Point3} Point3 */
/** @typedef {import('./view3d.js').SensorModel} SensorModel */
/** @typedef {{origin: Point3, direction: Point3}} Ray3 */

/**
 * The ray of cell (i, j), in the scene frame. Both may be fractions: the ray of a witness is displaced by a
 * part of a cell. Null for a sensor without a camera and without a grid.
 * @param {SensorModel} sensor
 * @param {number} i
 * @param {number} j
 * @returns {Ray3 | null}
 */
export function rayOfPlace(sensor, i, j) {
  const { position, quaternion } = sensor.pose;
  if (sensor.camera) {
    const { pixel_pitch: pitch, principal_point: centre, focal_length: focal } = sensor.camera;
    const direction = vecTurn(quaternion, [
      (i + 0.5 - centre[0]) * pitch[0],
      (j + 0.5 - centre[1]) * pitch[1],
      focal,
    ]);
    return { origin: position, direction };
  }
  if (sensor.grid) {
    const { half_width: half, thickness, grid_distance: distance } = sensor.grid;
    const x = (half * (2 * i + 1 - sensor.width)) / sensor.width;
    const y = (thickness * (2 * j + 1 - sensor.height)) / (2 * sensor.height);
    return {
      origin: vecAdd(position, vecTurn(quaternion, [0, y, 0])),
      direction: vecTurn(quaternion, [x, 0, distance]),
    };
  }
  return null;
}

/**
 * The directions x right, y down and z forward of a sensor, unit vectors of the scene frame.
 * @param {SensorModel} sensor
 * @returns {{right: Point3, down: Point3, forward: Point3}}
 */
export function axesOfSensor(sensor) {
  const q = sensor.pose.quaternion;
  return { right: vecTurn(q, [1, 0, 0]), down: vecTurn(q, [0, 1, 0]), forward: vecTurn(q, [0, 0, 1]) };
}

/** A point of the sensor's frame in the scene frame. @param {SensorModel} sensor @param {Point3} local */
export function sceneFromSensor(sensor, local) {
  return vecAdd(sensor.pose.position, vecTurn(sensor.pose.quaternion, local));
}

/**
 * Where the camera images a point: column `u` and row `v` in pixels from the outer corner of pixel (0, 0),
 * and the depth along its axis in metres. A point that is not before the camera has no image.
 * @param {SensorModel} sensor
 * @param {Point3} point
 * @returns {{u: number, v: number, depth: number, onImage: boolean} | null}
 */
export function imageOfPoint(sensor, point) {
  if (!sensor.camera) return null;
  const { pixel_pitch: pitch, principal_point: centre, focal_length: focal } = sensor.camera;
  const [x, y, depth] = vecTurnBack(sensor.pose.quaternion, vecSub(point, sensor.pose.position));
  if (!(depth > 0)) return null;
  const u = centre[0] + (focal * x) / (depth * pitch[0]);
  const v = centre[1] + (focal * y) / (depth * pitch[1]);
  return { u, v, depth, onImage: u >= 0 && v >= 0 && u < sensor.width && v < sensor.height };
}

/**
 * The point that the camera images at (u, v) pixels, on the plane in this depth.
 * @param {SensorModel} sensor
 * @param {number} u
 * @param {number} v
 * @param {number} depth metres
 * @returns {Point3}
 */
export function pointOfImage(sensor, u, v, depth) {
  if (!sensor.camera) return sensor.pose.position;
  const { pixel_pitch: pitch, principal_point: centre, focal_length: focal } = sensor.camera;
  /** @type {Point3} */
  const local = [(u - centre[0]) * pitch[0], (v - centre[1]) * pitch[1], focal];
  return sceneFromSensor(sensor, vecScale(local, depth / focal));
}

/** The word for a cell of this sensor. @param {SensorModel} sensor */
export function cellWordOf(sensor) {
  return sensor.kind === 'camera' ? 'pixel' : 'pencil';
}
