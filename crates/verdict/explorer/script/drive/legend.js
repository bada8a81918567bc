// The key of the map: the scale of its colours, ways, and the labels of sectors with their marks.

import { inkOn, packedHex } from '../panel/colour.js';
import { element } from '../elements.js';
import { DRIVE_LABELS, DRIVE_SOURCES } from './model.js';
import { LABEL_LOOKS, SOURCE_COLOURS, labelSwatch } from './looks.js';
import { CLIPPED_WORDS, colourBar } from '../panel/legend.js';
import { SOURCE_MARKS } from './cell_marks.js';

/** @typedef {import('./state.js').DriveState} DriveState */
/** @typedef {import('./map.js').DriveMap} DriveMap */

/** @param {DriveState} state @param {DriveMap} map */
export function driveLegend(state, map) {
  const host = element('div', { class: 'drive-legend', 'data-drive-legend': true });
  const show = () => host.replaceChildren(colours(state, map), keys(map));
  state.listen((changed) => { if (changed.has('colouring')) { show(); } });
  show();
  return { element: host, show };
}

/** @param {DriveState} state @param {DriveMap} map */
function colours(state, map) {
  const { colouring } = state.choice;
  const { scale } = map;
  if (colouring === 'source') {
    const entries = [3, 2, 1].map((source) => {
      const block = element('i', { class: 'drive-block' }, SOURCE_MARKS[source]);
      const name = SOURCE_COLOURS[source];
      if (name) {
        block.style.background = map.theme[name];
        block.style.color = inkOn(packedHex(map.theme[name]));
      }
      return element('span', { class: 'x-key' }, block, DRIVE_SOURCES[source]);
    });
    return element('div', { class: 'x-keys' }, ...entries);
  }
  if (!scale) {
    return element('p', { class: 'drive-soft' }, 'The true ground is not known.');
  }
  // Elevations are read in the global frame.
  const [title, shift] = colouring === 'elevation'
    ? ['elevation, z', map.record.origin[2]] : ['elevation of the map minus true height', 0];
  const shifted = { ...scale, low: scale.low + shift, high: scale.high + shift };
  return element('div', { 'data-drive-scale': true }, colourBar(shifted, 'm', title, map.view.width),
    element('div', { class: 'x-keys' }, scale.isClipped ? CLIPPED_WORDS : ''));
}

/** @param {DriveMap} map */
function keys(map) {
  const entry = (/** @type {Element} */ sample, /** @type {string} */ words) => (
    element('span', { class: 'x-key' }, sample, words));
  const line = (/** @type {string} */ kind) => element('i', { class: `drive-line drive-line-${kind}` });
  return element('div', { class: 'x-keys' },
    entry(line('true'), 'true way and vehicle'), entry(line('believed'), 'believed way and vehicle'),
    ...DRIVE_LABELS.map((label) => entry(labelSwatch(label, map.theme), `sector: ${LABEL_LOOKS[label].words}`)));
}
