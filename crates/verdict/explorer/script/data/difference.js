// Differences of two sides, as rasters and of single numbers.

import { NOTHING, SATURATED_ULPS } from './page_model.js';
import { doubleUlp } from './numbers.js';
import { isNamed } from './channels.js';

/** @typedef {import('./page_data.js').PageData} PageData */
/** @typedef {import('./channels.js').Channel} Channel */

/** Codes of a raster of differences of names: faces, visibility. */
export const SAME_NAME = 0;
const OTHER_NAME = 1;
export const ONE_SIDED = 2;
export const NO_NAME = 255;

/**
 * The difference b - a of each cell. Of names it is a Uint8Array with the codes above. NaN: neither side
 * hits;
 * Infinity: one of them does not.
 * @param {PageData} data @param {number} sensor @param {number} a @param {number} b @param {Channel} channel
 * @returns {Promise<Float32Array|Uint8Array|null>}
 */
export async function differenceRaster(data, sensor, a, b, channel) {
  if (channel.drawing === 'normal') {
    return anglesBetween(data, sensor, a, b);
  }
  const [ofA, ofB] = await Promise.all([
    data.raster(sensor, a, channel.key),
    data.raster(sensor, b, channel.key),
  ]);
  if (!ofA || !ofB) {
    return null;
  }
  if (isNamed(channel.drawing)) {
    const codes = new Uint8Array(ofA.length);
    const nothing = channel.drawing === 'faces' ? NOTHING : -1;
    for (let cell = 0; cell < codes.length; cell += 1) {
      const [one, other] = [ofA[cell], ofB[cell]];
      if (one === other) {
        codes[cell] = one === nothing ? NO_NAME : SAME_NAME;
      } else {
        codes[cell] = one === nothing || other === nothing ? ONE_SIDED : OTHER_NAME;
      }
    }
    return codes;
  }
  const found = data.pairOf(sensor, a, b);
  const ulps =
    channel.key === 'range.T' && found?.pair.range_ulps
      ? await data.container.decode(found.pair.range_ulps)
      : null;
  const sign = found?.isTurned ? -1 : 1;
  const differences = new Float32Array(ofA.length);
  for (let cell = 0; cell < differences.length; cell += 1) {
    differences[cell] = differenceOf(ofA[cell], ofB[cell], ulps ? sign * ulps[cell] : null);
  }
  return differences;
}

/**
 * Angles between the normals, degrees.
 * @param {PageData} data
 * @param {number} sensor
 * @param {number} a
 * @param {number} b
 */
async function anglesBetween(data, sensor, a, b) {
  const axes = ['N.X', 'N.Y', 'N.Z'];
  const rasters = await Promise.all(
    [a, b].flatMap((side) => axes.map((axis) => data.raster(sensor, side, axis))),
  );
  const [ax, ay, az, bx, by, bz] = rasters;
  if (!ax || !ay || !az || !bx || !by || !bz) {
    return null;
  }
  const angles = new Float32Array(ax.length);
  for (let cell = 0; cell < angles.length; cell += 1) {
    const hitsA = !Number.isNaN(ax[cell]);
    const hitsB = !Number.isNaN(bx[cell]);
    if (!hitsA || !hitsB) {
      angles[cell] = hitsA === hitsB ? NaN : Infinity;
      continue;
    }
    const x = ay[cell] * bz[cell] - by[cell] * az[cell];
    const y = az[cell] * bx[cell] - bz[cell] * ax[cell];
    const z = ax[cell] * by[cell] - bx[cell] * ay[cell];
    const dot = ax[cell] * bx[cell] + ay[cell] * by[cell] + az[cell] * bz[cell];
    angles[cell] = (Math.atan2(Math.sqrt(x * x + y * y + z * z), dot) * 180) / Math.PI;
  }
  return angles;
}

/**
 * The difference of two recorded numbers. Of ranges it is that of the renderers' f64 ranges, if the page has
 * it.
 * @param {number} a
 * @param {number} b
 * @param {number|null} ulps steps of f64 from a to b
 * @returns {number} NaN: neither side hits; Infinity: one of them does not, or for one only it is too near
 */
export function differenceOf(a, b, ulps) {
  const hasA = Number.isFinite(a) && a !== NOTHING;
  const hasB = Number.isFinite(b) && b !== NOTHING;
  if (!hasA || !hasB) {
    const isAlike = hasA === hasB && (a === -Infinity) === (b === -Infinity);
    return isAlike ? NaN : Infinity;
  }
  return ulps !== null && Math.abs(ulps) < SATURATED_ULPS ? ulps * doubleUlp(a) : b - a;
}
