// The read-out: what is known of a cell of the map and of a sector, in numbers and words.
//
// For tests: `[data-drive-readout="cell"]` and `[data-drive-readout="sector"]`. Each value is the text of a
// `[data-drive-value="elevation"]` (also `source`, `truth`, `difference`, `since`, `i`: "i, j", `x`: "x, y m"; for a
// sector `number`, `label`, `radius`, `direction`, `reason`, `missing`).

import { element } from '../elements.js';
import { DRIVE_SOURCES } from './model.js';
import { LABEL_LOOKS } from './looks.js';
import { NO_SLOT } from './replay.js';
import { degreesOf } from './sectors.js';

/** @typedef {import('./state.js').DriveState} DriveState */
/** @typedef {import('./map.js').DriveMap} DriveMap */

/** A length in metres, to a tenth of a millimetre. @param {number} value */
function metres(value) {
  return Number.isNaN(value) ? 'none' : `${value.toFixed(4).replace('-', '−')} m`;
}

export class DriveReadout {
  /** @param {DriveState} state @param {DriveMap} map */
  constructor(state, map) {
    this.state = state;
    this.map = map;
    this.cell = element('div', { 'data-drive-readout': 'cell' });
    this.sector = element('div', { 'data-drive-readout': 'sector' });
    this.element = element('div', { class: 'drive-readout' }, this.cell, this.sector);
    state.listen(() => this.show());
  }

  show() {
    this.showCell();
    this.showSector();
  }

  /** All that is known of the shown cell, as a sentence. */
  cellWords() {
    const names = [...this.cell.querySelectorAll('dt')].map((name) => name.textContent);
    const values = [...this.cell.querySelectorAll('dd')].map((value) => value.textContent);
    return `${names.map((name, k) => `${name} ${values[k]}`).join('; ')}.`;
  }

  showCell() {
    const { choice } = this.state;
    const cell = choice.hoverCell ?? choice.cell;
    if (!cell) {
      this.cell.replaceChildren(element('h3', {}, 'Cell'),
        element('p', { class: 'drive-soft' },
          'Point at the map, or move the cursor with Shift and the arrow keys.'));
      return;
    }
    const { replay, record, truth } = this.map;
    replay.goTo(choice.frame);
    const [i, j] = cell;
    const slot = replay.slotOf(i, j);
    const [x, y] = replay.placeOf(i, j);
    const source = slot === NO_SLOT ? 0 : replay.source[slot];
    const isKnown = source !== 0;
    const height = slot === NO_SLOT ? truth?.ground.heightAt(x, y) ?? NaN : truth?.heightOf(slot) ?? NaN;
    const elevation = isKnown ? replay.elevation[slot] : NaN;
    const since = isKnown ? replay.since[slot] : -1;
    this.cell.replaceChildren(element('h3', {}, choice.hoverCell ? 'Cell under the pointer' : 'Chosen cell'), list([
      ['i', 'cell (i, j)', `${i}, ${j}`],
      ['x', 'x, y', placeWords2d(x + record.origin[0], y + record.origin[1])],
      ['elevation', 'elevation', isKnown ? metres(elevation + record.origin[2]) : 'unknown'],
      ['source', 'source', DRIVE_SOURCES[source]],
      ['truth', 'true height', truth ? metres(height + record.origin[2]) : 'not known'],
      ['difference', 'map − truth', isKnown && !Number.isNaN(height) ? signedMetres(elevation - height) : 'none'],
      ['since', 'since', isKnown ? `frame ${record.frames[since]}, ${record.timeOf(since).toFixed(1)} s` : 'none'],
    ]));
  }

  showSector() {
    const { choice } = this.state;
    const index = choice.hoverSector >= 0 ? choice.hoverSector : choice.sector;
    const { obstacles, record } = this.map;
    const sector = obstacles?.sectors[index];
    if (!obstacles || !sector) {
      const words = obstacles
        ? 'Point at a sector, or choose one with n and p.' : 'No obstacle map has been made yet.';
      const line = element('p', { class: 'drive-soft' }, words);
      this.sector.replaceChildren(element('h3', {}, 'Sector'), line);
      return;
    }
    /** @type {[string, string, string][]} */
    const rows = [
      ['number', 'sector', `${index} of ${obstacles.sectors.length}, frame ${record.frames[obstacles.frame]}`],
      ['label', 'label', LABEL_LOOKS[sector.label]?.words ?? sector.label],
      ['radius', 'radius', `${sector.radius.toFixed(2)} m`],
      ['direction', 'direction', `${degreesOf(sector)}° to the left of x`],
      ['reason', 'reason', sector.reason],
    ];
    if (sector.missing) {
      const [x, y] = sector.missing;
      rows.push(['missing', 'missing place', placeWords2d(x + record.origin[0], y + record.origin[1])]);
    }
    const title = choice.hoverSector >= 0 ? 'Sector under the pointer' : 'Chosen sector';
    this.sector.replaceChildren(element('h3', {}, title), list(rows));
  }
}

/** A place of the plan. @param {number} x metres @param {number} y */
function placeWords2d(x, y) {
  return `${x.toFixed(2)}, ${y.toFixed(2)} m`.replaceAll('-', '−');
}

/** @param {number} value metres */
function signedMetres(value) {
  return value > 0 ? `+${metres(value)}` : metres(value);
}

/** @param {[string, string, string][]} rows key, name, value */
function list(rows) {
  const made = element('dl', { class: 'drive-values' });
  for (const [key, name, value] of rows) {
    made.append(element('dt', {}, name), element('dd', { 'data-drive-value': key }, value));
  }
  return made;
}
