// Scales of the map's colours: elevation, and error against the true ground, the same over the whole drive.

import { percentile } from '../data/limits.js';

/** @typedef {import('./model.js').DriveRecord} DriveRecord */
/** @typedef {import('./replay.js').MapReplay} MapReplay */
/** @typedef {import('./ground.js').DriveGround} DriveGround */
/** Ends in metres; elevations are those of the scene frame. @typedef {import('../data/limits.js').ColourScale} ColourScale */
/** @typedef {'elevation'|'source'|'error'} MapColouring */

/** Changes from which percentiles are taken. */
const SCALE_SAMPLE = 20000;

/** Smallest error at the ends of the scale, metres. */
const LEAST_ERROR = 0.002;

/** Every so-manieth change that makes a cell known. @param {DriveRecord} record */
function sampledChanges(record) {
  const step = Math.max(1, Math.floor(record.i.length / SCALE_SAMPLE));
  const sample = [];
  for (let change = 0; change < record.i.length; change += step) {
    if (record.source[change] !== 0) {
      sample.push(change);
    }
  }
  return sample;
}

/** Elevations from the lowest to the highest hundredth. @param {DriveRecord} record @returns {ColourScale} */
export function elevationScale(record) {
  const values = sampledChanges(record).map((change) => record.elevation[change]).sort((a, b) => a - b);
  const [low, high] = [percentile(values, 0.01), percentile(values, 0.99)];
  if (!(low <= high)) {
    return { spread: 'linear', low: -1, high: 1, floor: 0, map: 'viridis', isClipped: false };
  }
  const room = high - low < 0.02 ? 0.01 : 0;
  const isClipped = values[0] < low - room || values[values.length - 1] > high + room;
  return { spread: 'linear', low: low - room, high: high + room, floor: 0, map: 'viridis', isClipped };
}

/** Errors about zero, up to those that one in fifty exceeds. @param {MapReplay} replay @param {DriveGround} ground
 * @returns {ColourScale} */
export function errorScale(replay, ground) {
  const { record } = replay;
  const errors = sampledChanges(record).map((change) => {
    const [x, y] = replay.placeOf(record.i[change], record.j[change]);
    return Math.abs(record.elevation[change] - ground.heightAt(x, y));
  }).filter(Number.isFinite).sort((a, b) => a - b);
  const limit = Math.max(LEAST_ERROR, percentile(errors, 0.98) || 0);
  const isClipped = (errors[errors.length - 1] ?? 0) > limit;
  return { spread: 'signed', low: -limit, high: limit, floor: 0, map: 'blue-red', isClipped };
}
