// Numbers of an axis of a raster, in words.

import { plain } from '../data/numbers.js';

/** @typedef {import('../data/page_model.js').RasterAxis} RasterAxis */

/** A number of an axis with its unit. @param {RasterAxis} axis @param {number} value */
export function axisWords(axis, value) {
  const turn = axis.turns ? value - 360 * Math.round(value / 360) : value;
  return `${plain(Number(turn.toFixed(4)), 6)}${axis.unit === '°' ? '°' : ` ${axis.unit}`}`;
}
