// The sensors on the moving vehicle: their poses at any frame follow from those at the start.

import { vecAdd, vecLength, vecSub, vecTurn, vecTurnBack } from '../view3d/vector.js';
import { rayOfPlace } from '../view3d/sensor.js';

/** @typedef {import('../view3d/vector.js').Point3} Point3 */
/** @typedef {import('../view3d/view3d.js').SensorModel} SensorModel3d */
/** @typedef {import('../view3d/rig.js').SheetEnds} SheetEnds */
/** @typedef {import('./model.js').DriveRecord} DriveRecord */
/** @typedef {import('./model.js').DrivePose} DrivePose */
/** @typedef {import('./ground.js').DriveGround} DriveGround */
/** @typedef {[number, number, number, number]} Turn x, y, z, w */

/** Steps across the fan of a sheet. */
const FAN_STEPS = 48;

/** The turn `b`, then the turn `a`. @param {Turn} a @param {Turn} b @returns {Turn} */
function turnAfter(a, b) {
  const [ax, ay, az, aw] = a;
  const [bx, by, bz, bw] = b;
  return [
    aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx,
    aw * bz + ax * by - ay * bx + az * bw, aw * bw - ax * bx - ay * by - az * bz,
  ];
}

export class DriveMounts {
  /** @param {DriveRecord} record */
  constructor(record) {
    this.sensors = /** @type {SensorModel3d[]} */ (/** @type {unknown} */ (record.model.sensors));
    const start = record.truePose(0);
    const [x, y, z, w] = start.quaternion;
    /** @type {Turn} */
    const back = [-x, -y, -z, w];
    /** Poses of the sensors in the vehicle frame. @type {DrivePose[]} */
    this.onVehicle = this.sensors.map(({ pose }) => ({
      position: vecTurnBack(start.quaternion, vecSub(pose.position, start.position)),
      quaternion: turnAfter(back, pose.quaternion),
    }));
  }

  /** Places of the sensors in the vehicle frame. */
  get places() {
    return this.onVehicle.map((pose) => pose.position);
  }

  /** The sensors with the vehicle at a pose. @param {DrivePose} vehicle @returns {SensorModel3d[]} */
  at(vehicle) {
    return this.sensors.map((sensor, index) => ({
      ...sensor,
      pose: {
        position: vecAdd(vehicle.position, vecTurn(vehicle.quaternion, this.onVehicle[index].position)),
        quaternion: turnAfter(vehicle.quaternion, this.onVehicle[index].quaternion),
      },
    }));
  }
}

/** Where a sheet ends on the true ground. @param {SensorModel3d} sensor @param {DriveGround} ground
 * @returns {SheetEnds} */
export function sheetEndsOn(sensor, ground) {
  const ends = { upper: new Float64Array(FAN_STEPS + 1), lower: new Float64Array(FAN_STEPS + 1) };
  for (const [edge, row] of /** @type {const} */ ([['upper', -0.5], ['lower', sensor.height - 0.5]])) {
    for (let step = 0; step <= FAN_STEPS; step += 1) {
      const ray = rayOfPlace(sensor, step / FAN_STEPS * sensor.width - 0.5, row);
      const length = ray ? vecLength(ray.direction) : 1;
      const farthest = sensor.max_range / length;
      const hit = ray ? ground.rayHit(ray.origin, ray.direction, farthest) : farthest;
      ends[edge][step] = length * hit;
    }
  }
  return ends;
}
