// The address of a cell: `#camera/412,300`, `#beam-0/412,3/flux.V/diff`, and `/A~B` if other sides are shown.

import { PICTURE_MODES } from '../state.js';

/** @typedef {import('./page_model.js').PageModel} PageModel */
/** @typedef {import('../state.js').Choice} Choice */

/**
 * Short words for modes that addresses may have too.
 * @type {Record<string, import('../state.js').PictureMode>}
 */
const SHORT_MODES = { diff: 'difference', A: 'a', B: 'b' };

/** @param {PageModel} model @param {number} sensor @param {number} cell */
export function hashOfCell(model, sensor, cell) {
  const { name, width } = model.sensors[sensor];
  return `#${encodeURIComponent(name)}/${cell % width},${Math.floor(cell / width)}`;
}

/**
 * The address of what is shown. Parts that have their plain value are left out.
 * @param {PageModel} model @param {Choice} choice @param {Choice} plain
 */
export function hashOfChoice(model, choice, plain) {
  const parts = [hashOfCell(model, choice.sensor, choice.cell)];
  const hasSides = choice.a !== plain.a || choice.b !== plain.b;
  const hasMode = choice.mode !== plain.mode || hasSides;
  if (choice.channel !== plain.channel || hasMode) {
    parts.push(choice.channel);
  }
  if (hasMode) {
    parts.push(choice.mode === 'difference' ? 'diff' : choice.mode);
  }
  if (hasSides) {
    parts.push(
      [choice.a, choice.b].map((side) => encodeURIComponent(model.sides[side]?.name ?? '')).join('~'),
    );
  }
  return parts.join('/');
}

/**
 * What an address asks for; null if it is none of this page's cells.
 * @param {PageModel} model @param {string} hash
 * @returns {Partial<Choice>|null}
 */
export function choiceOfHash(model, hash) {
  const [name, place, channel, mode, sides] = hash.replace(/^#/, '').split('/');
  const sensor = model.sensors.findIndex((known) => known.name === decoded(name));
  const cell = /^(\d+),(\d+)$/.exec(place ?? '');
  if (sensor < 0 || !cell) {
    return null;
  }
  const { width, height } = model.sensors[sensor];
  const [i, j] = [Number(cell[1]), Number(cell[2])];
  if (i >= width || j >= height) {
    return null;
  }
  /** @type {Partial<Choice>} */
  const asked = { sensor, cell: j * width + i };
  if (channel) {
    asked.channel = decoded(channel);
  }
  const known = SHORT_MODES[mode] ?? PICTURE_MODES.find(([one]) => one === mode)?.[0];
  if (known) {
    asked.mode = known;
  }
  const [a, b] = (sides ?? '')
    .split('~')
    .map((side) => model.sides.findIndex((one) => one.name === decoded(side)));
  if (a >= 0 && b >= 0) {
    asked.a = a;
    asked.b = b;
  }
  return asked;
}

/** @param {string} text */
function decoded(text) {
  try {
    return decodeURIComponent(text ?? '');
  } catch {
    return text;
  }
}
