// Scales of the map's colours: elevation, and error against the true ground, the same over the whole drive.

import { gradientOf } from '../panel/colour.js';
import { element } from '../elements.js';
import { roundStep, tickInWords } from '../view3d/words.js';

/** @typedef {import('./model.js').DriveRecord} DriveRecord */
/** @typedef {import('./replay.js').MapReplay} MapReplay */
/** @typedef {import('./ground.js').DriveGround} DriveGround */
/** @typedef {import('../panel/colour.js').ColourMapName} ColourMapName */
/** @typedef {'elevation'|'source'|'error'} MapColouring */
/**
 * Ends of a scale, metres; elevations are those of the scene frame.
 * @typedef {{low: number, high: number, map: ColourMapName, isClipped: boolean}} MapScale
 */

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

/** @param {number[]} sorted @param {number} share 0 to 1 */
function atShare(sorted, share) {
  return sorted.length === 0 ? NaN : sorted[Math.round(share * (sorted.length - 1))];
}

/** Elevations from the lowest to the highest hundredth. @param {DriveRecord} record @returns {MapScale} */
export function elevationScale(record) {
  const values = sampledChanges(record).map((change) => record.elevation[change]).sort((a, b) => a - b);
  const [low, high] = [atShare(values, 0.01), atShare(values, 0.99)];
  if (!(low <= high)) {
    return { low: -1, high: 1, map: 'viridis', isClipped: false };
  }
  const room = high - low < 0.02 ? 0.01 : 0;
  const isClipped = values[0] < low - room || values[values.length - 1] > high + room;
  return { low: low - room, high: high + room, map: 'viridis', isClipped };
}

/** Errors about zero, up to those that one in fifty exceeds. @param {MapReplay} replay @param {DriveGround} ground
 * @returns {MapScale} */
export function errorScale(replay, ground) {
  const { record } = replay;
  const errors = sampledChanges(record).map((change) => {
    const [x, y] = replay.placeOf(record.i[change], record.j[change]);
    return Math.abs(record.elevation[change] - ground.heightAt(x, y));
  }).filter(Number.isFinite).sort((a, b) => a - b);
  const limit = Math.max(LEAST_ERROR, atShare(errors, 0.98) || 0);
  return { low: -limit, high: limit, map: 'blue-red', isClipped: (errors[errors.length - 1] ?? 0) > limit };
}

/**
 * The scale as a bar with ticks in metres.
 * @param {MapScale} scale @param {string} name @param {number} shift what is added for global coordinates, metres
 */
export function scaleBar(scale, name, shift) {
  const [low, high] = [scale.low + shift, scale.high + shift];
  const ramp = element('div', { class: 'drive-ramp' });
  ramp.style.background = gradientOf(scale.map);
  const bar = element('div', { class: 'drive-bar' }, ramp);
  const step = roundStep((high - low) / 3.5);
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k += 1) {
    const place = `${100 * (k * step - low) / (high - low)}%`;
    const line = element('i');
    const word = element('span', {}, tickInWords(k * step, step));
    line.style.left = place;
    word.style.left = place;
    bar.append(line, word);
  }
  const words = scale.isClipped ? `${name}, m (values beyond the ends have the colours of the ends)` : `${name}, m`;
  return element('div', { class: 'drive-scale', 'data-drive-scale': true },
    bar, element('div', { class: 'drive-soft' }, words));
}
