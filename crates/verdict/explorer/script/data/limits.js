// Limits of a colour scale: of all values, or robust against a few outliers; and round numbers as ticks.

import { roundAbove, withUnit } from './numbers.js';

/**
 * @typedef {object} ValueStatistics
 * @property {number} count finite values
 * @property {number} lowest
 * @property {number} highest
 * @property {number} largest largest absolute value
 * @property {Float64Array} sample sorted values, about `SAMPLE_SIZE` of them
 * @property {Float64Array} sizes sorted absolute values other than 0
 * @property {boolean} isOneSided whether some value is infinite: a hit on one side only
 * @property {boolean} isTooNear whether some value is -Infinity: nearer than a sensor's shortest range
 * @property {boolean} isMissing whether some value is missing: no hit
 */

/** Values from which percentiles are taken. */
const SAMPLE_SIZE = 6000;

/**
 * @param {ArrayLike<number>} values
 * @param {number} [nothing] an integer that stands for no value
 * @returns {ValueStatistics}
 */
export function statisticsOf(values, nothing = NaN) {
  let count = 0;
  let lowest = Infinity;
  let highest = -Infinity;
  let unlikeZero = 0;
  let isOneSided = false;
  let isTooNear = false;
  let isMissing = false;
  for (let k = 0; k < values.length; k += 1) {
    const value = values[k];
    // NaN fails both comparisons.
    if (value < Infinity && value > -Infinity && value !== nothing) {
      count += 1;
      if (value < lowest) {
        lowest = value;
      }
      if (value > highest) {
        highest = value;
      }
      if (value !== 0) {
        unlikeZero += 1;
      }
    } else if (value === Infinity) {
      isOneSided = true;
    } else if (value === -Infinity) {
      isTooNear = true;
    } else {
      isMissing = true;
    }
  }
  const largest = count === 0 ? 0 : Math.max(Math.abs(lowest), Math.abs(highest));
  const sample = sampleOf(values, nothing, count, false);
  const sizes = sampleOf(values, nothing, unlikeZero, true);
  return { count, lowest, highest, largest, sample, sizes, isOneSided, isTooNear, isMissing };
}

/**
 * Every so-manieth cell, so that the same raster always gives the same limits. Where few cells have a value,
 * all of them.
 * @param {ArrayLike<number>} values @param {number} nothing @param {number} count values that there are
 * @param {boolean} ofSizes absolute values other than 0
 */
function sampleOf(values, nothing, count, ofSizes) {
  const step = Math.max(1, Math.floor(count / SAMPLE_SIZE));
  const sample = new Float64Array(Math.ceil(values.length / step));
  let found = 0;
  for (let k = 0; k < values.length; k += step) {
    const value = values[k];
    if (value < Infinity && value > -Infinity && value !== nothing && !(ofSizes && value === 0)) {
      sample[found] = ofSizes ? Math.abs(value) : value;
      found += 1;
    }
  }
  return sample.slice(0, found).sort();
}

/** @param {ArrayLike<number>} sorted @param {number} share 0 to 1 */
export function percentile(sorted, share) {
  return sorted.length === 0 ? NaN : sorted[Math.round(share * (sorted.length - 1))];
}

/**
 * @typedef {object} ColourScale
 * @property {'linear'|'log'|'signed'|'signed-log'} spread
 * @property {number} low
 * @property {number} high
 * @property {number} floor of `signed-log`: the size below which all is near zero
 * @property {import('../panel/colour.js').ColourMapName} map
 * @property {boolean} isClipped whether values lie beyond the limits
 */

/** @typedef {{isRobust: boolean, isLog: boolean|null, exposure: number}} ScaleSettings */

/**
 * A scale of values, which both sides share.
 * @param {ValueStatistics[]} statistics
 * @param {ScaleSettings} settings
 * @param {boolean} isLight light starts at zero, which is black
 * @param {boolean} [isLength] lengths with ends far apart get even steps of the logarithm, unless settings
 *   say otherwise
 * @returns {ColourScale}
 */
export function scaleOfValues(statistics, settings, isLight, isLength = false) {
  const known = statistics.filter((one) => one.count > 0);
  const lowest = Math.min(...known.map((one) => one.lowest));
  const highest = Math.max(...known.map((one) => one.highest));
  if (known.length === 0) {
    return {
      spread: 'linear',
      low: 0,
      high: 1,
      floor: 0,
      map: isLight ? 'inferno' : 'viridis',
      isClipped: false,
    };
  }
  let low = settings.isRobust ? Math.min(...known.map((one) => percentile(one.sample, 0.01))) : lowest;
  let high = settings.isRobust ? Math.max(...known.map((one) => percentile(one.sample, 0.99))) : highest;
  if (isLight) {
    // Most pixels get no light. Percentiles are those of the others.
    low = 0;
    high = settings.isRobust ? Math.max(0, ...known.map((one) => percentile(one.sizes, 0.99) || 0)) : highest;
  }
  const isLog = (settings.isLog ?? (isLength && low > 0 && high >= 3 * low)) && high > 0;
  const gain = 2 ** settings.exposure;
  if (isLog) {
    const smallest = Math.min(
      ...known.map((one) => (one.sizes.length > 0 ? percentile(one.sizes, 0.01) : Infinity)),
    );
    low = low > 0 ? low : Math.min(smallest, high / 10);
    low = Math.max(low, high * 1e-12);
    return {
      spread: 'log',
      low: low / gain,
      high: (high > low ? high : low * 10) / gain,
      floor: 0,
      map: isLight ? 'inferno' : 'viridis',
      isClipped: high < highest || low > lowest,
    };
  }
  const span = high > low ? high - low : Math.max(Math.abs(high), 1) * 1e-3;
  return {
    spread: 'linear',
    low,
    high: low + span / gain,
    floor: 0,
    map: isLight ? 'inferno' : 'viridis',
    isClipped: low > lowest || low + span / gain < highest,
  };
}

/**
 * A scale of signed differences: zero is in the middle.
 * @param {ValueStatistics} statistics
 * @param {ScaleSettings} settings
 * @returns {ColourScale}
 */
export function scaleOfDifferences(statistics, settings) {
  const { sizes, largest } = statistics;
  const gain = 2 ** settings.exposure;
  const limit = (settings.isRobust ? percentile(sizes, 0.99) || largest : largest) || 1;
  const smallest = percentile(sizes, 0.05) || limit;
  // Differences by rounding lie many decades below those by an error. A linear scale hides them.
  const isLog = settings.isLog ?? limit > 1000 * (percentile(sizes, 0.5) || limit);
  const floor = Math.max(Math.min(smallest, limit / 10), limit * 1e-14);
  return {
    spread: isLog ? 'signed-log' : 'signed',
    low: -limit / gain,
    high: limit / gain,
    floor: floor / gain,
    map: 'blue-red',
    isClipped: limit / gain < largest,
  };
}

/**
 * A function from the value to its place on the scale, 0 to 1. Values beyond the ends are beyond 0 and 1.
 * @param {ColourScale} scale
 * @returns {(value: number) => number}
 */
export function placeOn(scale) {
  const { low, high, floor } = scale;
  switch (scale.spread) {
    case 'log': {
      const factor = 1 / Math.log(high / low);
      return (value) => (value > low ? Math.log(value / low) * factor : 0);
    }
    case 'signed-log': {
      const factor = 0.5 / Math.log1p(high / floor);
      return (value) => 0.5 + (value < 0 ? -Math.log1p(-value / floor) : Math.log1p(value / floor)) * factor;
    }
    default: {
      const factor = 1 / (high - low);
      return (value) => (value - low) * factor;
    }
  }
}

/**
 * Ticks with round numbers.
 * @param {ColourScale} scale
 * @param {string} unit
 * @param {number} most number of ticks
 * @returns {{at: number, label: string}[]}
 */
export function ticksOf(scale, unit, most) {
  const place = placeOn(scale);
  let values;
  if (scale.spread === 'log') {
    values = decadesBetween(scale.low, scale.high, most);
  } else if (scale.spread === 'signed-log') {
    const above = decadesBetween(scale.floor, scale.high, Math.max(1, Math.floor((most - 1) / 2)));
    values = [...above.map((value) => -value).reverse(), 0, ...above];
  } else {
    values = roundSteps(scale.low, scale.high, most);
  }
  return values
    .map((value) => ({ at: place(value), label: withUnit(value, unit, 6) }))
    .filter((tick) => tick.at >= -1e-9 && tick.at <= 1 + 1e-9);
}

/** @param {number} low @param {number} high @param {number} most */
function roundSteps(low, high, most) {
  const step = roundAbove((0.999 * (high - low)) / Math.max(1, most - 1));
  const first = Math.ceil(low / step - 1e-9);
  const last = Math.floor(high / step + 1e-9);
  const values = [];
  for (let k = first; k <= last && values.length < 50; k += 1) {
    // The product may have stray digits in its last places.
    values.push(Number((k * step).toPrecision(12)));
  }
  return values;
}

/**
 * Round numbers for even steps of the logarithm.
 * @param {number} low
 * @param {number} high
 * @param {number} most
 */
function decadesBetween(low, high, most) {
  const first = Math.floor(Math.log10(low) + 1e-9);
  const last = Math.floor(Math.log10(high) + 1e-9);
  const isFew = last - first < 3;
  const step = isFew ? 1 : Math.max(1, Math.ceil((last - first) / most));
  const values = [];
  for (let power = last; power >= first; power -= step) {
    for (const digit of isFew ? [5, 2, 1] : [1]) {
      const value = Number(`${digit}e${power}`);
      if (value >= low * (1 - 1e-9) && value <= high * (1 + 1e-9)) {
        values.unshift(value);
      }
    }
  }
  return values.length >= 3 || !isFew ? values : roundSteps(low, high, most).filter((value) => value > 0);
}
