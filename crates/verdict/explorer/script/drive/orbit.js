// Ready-made poses of the eye in the drive's 3-D picture.

import { orbitPose } from '../view3d/camera.js';
import { vecAdd, vecTurn } from '../view3d/vector.js';

/** @typedef {import('../view3d/camera.js').EyePose} EyePose */
/** @typedef {import('./model.js').DrivePose} DrivePose */
/** @typedef {import('./relief.js').PlanBox} PlanBox */

/** The way the eye looks at a vehicle or at a plan: to the left of the heading, and downward, radians. */
const FROM_BEHIND = { yaw: 0.75, pitch: 0.5 };

/** Heading of a vehicle, radians. @param {DrivePose} vehicle */
function headingOf(vehicle) {
  const forward = vecTurn(vehicle.quaternion, [1, 0, 0]);
  return Math.atan2(forward[1], forward[0]);
}

/** From behind and above, at the ground ahead of the vehicle. @param {DrivePose} vehicle
 * @param {number} distance metres @returns {EyePose} */
export function poseOnVehicle(vehicle, distance) {
  const ahead = vecTurn(vehicle.quaternion, [2, 0, 0.5]);
  const yaw = headingOf(vehicle) + FROM_BEHIND.yaw;
  return orbitPose(vecAdd(vehicle.position, ahead), distance, yaw, FROM_BEHIND.pitch);
}

/** The whole map. @param {PlanBox} box @param {DrivePose} vehicle @param {boolean} isFromAbove
 * @returns {EyePose} */
export function poseOnPlan(box, vehicle, isFromAbove) {
  const size = Math.hypot(box.right - box.left, box.top - box.bottom);
  /** @type {import('../view3d/vector.js').Point3} */
  const centre = [(box.left + box.right) / 2, (box.bottom + box.top) / 2, vehicle.position[2]];
  return isFromAbove
    ? orbitPose(centre, size * 1.15, Math.PI / 2, Math.PI / 2)
    : orbitPose(centre, size * 1.1, headingOf(vehicle) + FROM_BEHIND.yaw, 0.65);
}
