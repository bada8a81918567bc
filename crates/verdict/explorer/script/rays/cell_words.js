// Words for the recorded numbers of a cell.

import { CLASS_NAMES, NOTHING } from '../data/page_model.js';
import { shortestSingle } from '../data/numbers.js';

/** @typedef {import('../data/channels.js').Channel} Channel */
/** @typedef {import('../data/cell_reading.js').CellReading} CellReading */

/**
 * A recorded number with all its digits, or what stands in its place.
 * @param {number} value @param {boolean} isGiven @param {Channel} channel
 */
export function recordedWords(value, isGiven, channel) {
  if (!isGiven) {
    return 'not given';
  }
  if (channel.drawing === 'yes-no') {
    return value === 0 ? 'no' : 'yes';
  }
  if (value === NOTHING) {
    return channel.key === 'face.I' ? 'none' : 'off the image';
  }
  return Number.isFinite(value) ? shortestSingle(value) : noValueWords(value);
}

/** What a number that is not finite stands for. (REP-117) @param {number} value */
function noValueWords(value) {
  return value === -Infinity ? 'too near' : 'no hit';
}

/**
 * A cell for people who listen.
 * @param {CellReading} reading
 * @param {Channel} channel
 * @param {string[]} names
 */
export function spokenWords(reading, channel, names) {
  const [a, b] = [
    recordedWords(reading.a, reading.hasA, channel),
    recordedWords(reading.b, reading.hasB, channel),
  ];
  const className = CLASS_NAMES[reading.code];
  return `${channel.title}: ${names[0]} ${a}, ${names[1]} ${b}.${className ? ` Class ${className}.` : ''}`;
}
