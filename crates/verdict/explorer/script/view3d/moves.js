// Moves of the eye by hand: to turn, to shift, to zoom. Each makes a pose from the one before.

import { vecAdd, vecAlong, vecDot, vecScale, vecSub } from './vector.js';
import { orbitOfPose, orbitPose } from './camera.js';

/** @typedef {import('./camera.js').EyePose} EyePose */
/** @typedef {import('./camera.js').ViewCamera} ViewCamera */
/** @typedef {import('./terrain.js').Bounds3} Bounds3 */

/** Radians for a drag of one CSS pixel. */
const TURN_PER_PIXEL = 0.006;
/** Smallest distance of the eye from what it turns about, metres. */
const NEAREST_EYE = 1e-6;

/**
 * The eye, turned about its focus, with the free lens.
 * @param {ViewCamera} camera
 * @param {number} dx CSS pixels
 * @param {number} dy
 * @returns {EyePose}
 */
export function turnedPose(camera, dx, dy) {
  const { yaw, pitch, distance } = orbitOfPose(camera.pose);
  const steepest = Math.PI / 2;
  const next = Math.max(-steepest, Math.min(steepest, pitch + dy * TURN_PER_PIXEL));
  return orbitPose(camera.pose.focus, distance, yaw - dx * TURN_PER_PIXEL, next);
}

/**
 * The picture, shifted by so many pixels: the image of a sensor, or the eye with its focus.
 * @param {ViewCamera} camera
 * @param {number} dx CSS pixels
 * @param {number} dy
 * @returns {EyePose}
 */
export function movedPose(camera, dx, dy) {
  const { pose } = camera;
  const { lens } = pose;
  if (lens.kind === 'image') {
    const cell = camera.cellSize;
    return { ...pose, lens: { ...lens, u: lens.u - dx / cell, v: lens.v - dy / cell } };
  }
  const scale = camera.metresPerPixel;
  const shift = vecAdd(vecScale(pose.axes.right, -dx * scale), vecScale(pose.axes.down, -dy * scale));
  return { ...pose, eye: vecAdd(pose.eye, shift), focus: vecAdd(pose.focus, shift) };
}

/**
 * The picture, zoomed. What is under the pointer stays there.
 * @param {ViewCamera} camera
 * @param {number} factor of distances: below 1 things become larger
 * @param {number} x place of the pointer, CSS pixels
 * @param {number} y
 * @param {Bounds3} bounds of everything, to end at
 * @returns {EyePose}
 */
export function zoomedPose(camera, factor, x, y, bounds) {
  const { pose } = camera;
  const { lens } = pose;
  if (lens.kind === 'image') {
    const zoom = Math.max(0.5, Math.min(2000, lens.zoom / factor));
    const dx = (x - camera.width / 2) / camera.cellSize;
    const dy = (y - camera.height / 2) / camera.cellSize;
    const kept = 1 - lens.zoom / zoom;
    return { ...pose, lens: { ...lens, zoom, u: lens.u + dx * kept, v: lens.v + dy * kept } };
  }
  const { distance } = orbitOfPose(pose);
  const { low, high } = bounds;
  const farthest = 20 * Math.max(high[0] - low[0], high[1] - low[1], 1e-3);
  const used = Math.max(NEAREST_EYE, Math.min(farthest, distance * factor)) / distance;
  const depth = vecDot(pose.axes.forward, vecSub(pose.focus, pose.eye));
  const under = vecAlong(pose.eye, camera.directionAt(x, y), depth);
  const focus = vecAlong(under, vecSub(pose.focus, under), used);
  return { ...pose, focus, eye: vecAlong(focus, pose.axes.forward, -distance * used) };
}
