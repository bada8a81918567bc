// Everything that the page knows of one cell.

import { SATURATED_ULPS } from './page_model.js';
import { doubleUlp, singleSteps } from './numbers.js';
import { boundOfCode } from './common_rasters.js';
import { placeOfCell } from './page_data.js';
import { differenceOf } from './difference.js';

/** @typedef {import('./page_data.js').PageData} PageData */
/** @typedef {import('./channels.js').Channel} Channel */

/**
 * @typedef {object} CellReading
 * @property {number} a value of side a; NaN if not given
 * @property {number} b
 * @property {boolean} hasA whether side a gives the channel
 * @property {boolean} hasB
 * @property {number} difference b - a; NaN or Infinity as above
 * @property {number} singleSteps steps of f32 from a to b
 * @property {number|null} doubleSteps steps of f64 of the renderers' ranges
 * @property {boolean} isSaturated whether `doubleSteps` is only a lower limit
 * @property {number} bound of the range difference, metres; NaN for none
 * @property {number} faceA
 * @property {number} faceB
 * @property {number} code class
 * @property {number} cause
 * @property {number} quantity
 * @property {{face: number, surface: number, visibility: number, landing: number}|null} margins
 */

/**
 * All that the page knows of one cell.
 * @param {PageData} data @param {number} sensor @param {number} a @param {number} b @param {Channel} channel
 * @param {number} cell
 * @returns {Promise<CellReading>}
 */
export async function readCell(data, sensor, a, b, channel, cell) {
  const key = channel.drawing === 'normal' ? 'N.Z' : channel.belongs === 'side' ? channel.key : 'range.T';
  const found = data.pairOf(sensor, a, b);
  const pair = found?.pair;
  /** @param {import('./container.js').ArrayReference|null|undefined} reference @param {number} missing */
  const at = async (reference, missing) =>
    reference ? (await data.container.decode(reference))[cell] : missing;
  const [ofA, ofB, faceA, faceB, code, cause, quantity, boundCode, steps, margins] = await Promise.all([
    data.value(sensor, a, key, cell),
    data.value(sensor, b, key, cell),
    data.value(sensor, a, 'face.I', cell),
    data.value(sensor, b, 'face.I', cell),
    at(pair?.class, 255),
    at(pair?.cause, 255),
    at(pair?.quantity, 255),
    at(pair?.range_bound, 0),
    at(pair?.range_ulps, NaN),
    marginsOf(data, sensor, cell),
  ]);
  const isRange = key === 'range.T';
  const doubleSteps =
    isRange && !Number.isNaN(steps) && Number.isFinite(ofA) && Number.isFinite(ofB)
      ? found?.isTurned
        ? -steps
        : steps
      : null;
  return {
    a: ofA,
    b: ofB,
    hasA: data.has(sensor, a, key),
    hasB: data.has(sensor, b, key),
    difference: differenceOf(ofA, ofB, doubleSteps),
    singleSteps: singleSteps(ofA, ofB),
    doubleSteps,
    isSaturated: doubleSteps !== null && Math.abs(doubleSteps) >= SATURATED_ULPS,
    bound: isRange ? boundOfCode(boundCode) : NaN,
    faceA,
    faceB,
    code,
    cause,
    quantity,
    margins,
  };
}

/** @param {PageData} data @param {number} sensor @param {number} cell */
async function marginsOf(data, sensor, cell) {
  const margins = data.model.sensors[sensor].margins;
  if (!margins) {
    return null;
  }
  const place = placeOfCell(await data.container.decode(margins.cells), cell);
  if (place < 0) {
    return null;
  }
  const names = /** @type {const} */ (['face', 'surface', 'visibility', 'landing']);
  const values = await Promise.all(
    names.map(async (name) => {
      const reference = margins[name];
      return reference ? (await data.container.decode(reference))[place] : NaN;
    }),
  );
  const [face, surface, visibility, landing] = values;
  return { face, surface, visibility, landing };
}

/**
 * The share of its bound that a difference of ranges uses; NaN without a bound.
 * @param {CellReading} reading
 */
export function shareOfBound(reading) {
  if (reading.doubleSteps === null || Number.isNaN(reading.bound)) {
    return NaN;
  }
  if (reading.isSaturated) {
    // So many steps that the recorded numbers, in single precision, tell the difference well enough.
    return Math.abs(reading.difference) / reading.bound;
  }
  return (Math.abs(reading.doubleSteps) * doubleUlp(reading.a)) / reading.bound;
}
