// Rasters that belong to a pair of sides or to a sensor alone: classes, causes, shares of bounds, margins.

import { doubleUlp } from './numbers.js';

/** @typedef {import('./page_data.js').PageData} PageData */
/** @typedef {import('./page_data.js').Raster} Raster */
/** @typedef {import('./page_model.js').SensorPairModel} SensorPairModel */

/**
 * @param {PageData} data
 * @param {number} sensorIndex
 * @param {number} pairIndex -1 for none
 * @param {string} channel
 * @returns {Promise<Raster|null>}
 */
export async function commonRaster(data, sensorIndex, pairIndex, channel) {
  if (channel.startsWith('margin.')) {
    return marginRaster(data, sensorIndex, channel.slice(7));
  }
  const pair = data.model.sensors[sensorIndex].pairs?.[pairIndex];
  if (!pair) {
    return null;
  }
  if (channel === 'share') {
    return boundShares(data, sensorIndex, pair);
  }
  const reference = channel === 'class' ? pair.class : pair.cause;
  return reference ? /** @type {Uint8Array} */ (await data.container.decode(reference)) : null;
}

/**
 * Margins of the rays that the referee ruled on; NaN for the others.
 * @param {PageData} data @param {number} sensorIndex @param {string} name
 */
async function marginRaster(data, sensorIndex, name) {
  const { margins, width, height } = data.model.sensors[sensorIndex];
  const reference = margins?.[/** @type {'face'} */ (name)];
  if (!margins || !reference) {
    return null;
  }
  const [cells, values] = await Promise.all([
    data.container.decode(margins.cells),
    data.container.decode(reference),
  ]);
  const all = new Float32Array(width * height).fill(NaN);
  for (let k = 0; k < cells.length; k += 1) {
    all[cells[k]] = values[k];
  }
  return all;
}

/**
 * |difference of the ranges| / bound; NaN without a bound.
 * @param {PageData} data @param {number} sensorIndex @param {SensorPairModel} pair
 */
async function boundShares(data, sensorIndex, pair) {
  if (!pair.range_ulps || !pair.range_bound) {
    return null;
  }
  const [ulps, bounds, ranges] = await Promise.all([
    data.container.decode(pair.range_ulps),
    data.container.decode(pair.range_bound),
    data.raster(sensorIndex, pair.a, 'range.T'),
  ]);
  const shares = new Float32Array(ulps.length).fill(NaN);
  for (let cell = 0; ranges && cell < shares.length; cell += 1) {
    if (bounds[cell] !== 0) {
      shares[cell] = (Math.abs(ulps[cell]) * doubleUlp(ranges[cell])) / boundOfCode(bounds[cell]);
    }
  }
  return shares;
}

/**
 * The bound of the difference of two ranges, metres; NaN for none.
 * @param {number} code
 */
export function boundOfCode(code) {
  return code === 0 ? NaN : 2 ** ((code - 1) / 4 - 60);
}
