// The table of the sectors of the current obstacle map: a row each, a click chooses.

import { button, element, setAttributes } from '../elements.js';
import { LABEL_LOOKS, labelSwatch } from './looks.js';
import { degreesOf, labelCounts } from './sectors.js';

/** @typedef {import('./state.js').DriveState} DriveState */
/** @typedef {import('./map.js').DriveMap} DriveMap */

const SECTOR_COLUMNS = ['sector', 'direction, °', 'radius, m', 'label and reason'];

export class SectorTable {
  /** @param {DriveState} state @param {DriveMap} map */
  constructor(state, map) {
    this.state = state;
    this.map = map;
    this.heading = element('p', { class: 'drive-soft', 'data-drive-sector-counts': true });
    this.body = element('tbody');
    const heads = SECTOR_COLUMNS.map((word) => element('th', { scope: 'col' }, word));
    const title = 'Sectors of the obstacle map';
    this.box = element('div', { class: 'drive-scroll', tabindex: '0', role: 'region', 'aria-label': title },
      element('table', { class: 'drive-table', 'data-drive-sectors': true },
        element('thead', {}, element('tr', {}, ...heads)), this.body));
    this.element = element('section', { class: 'drive-sectors' },
      element('h3', {}, title), this.heading, this.box);
    /** @type {HTMLTableRowElement[]} */
    this.rows = [];
    this.shown = -2;
    state.listen((changed) => {
      if (changed.has('frame')) { this.fill(); }
      if (changed.has('sector') || changed.has('hoverSector')) { this.mark(changed.has('sector')); }
    });
    this.fill();
  }

  fill() {
    const { record, obstacles } = this.map;
    const index = record.obstacleIndexAt(this.state.choice.frame);
    if (index === this.shown) { return; }
    this.shown = index;
    if (!obstacles) {
      this.heading.textContent = record.obstacles.length > 0
        ? `The first obstacle map is made in frame ${record.frames[record.obstacles[0].frame]}.`
        : 'The drive made no obstacle map.';
      this.rows = [];
      this.body.replaceChildren();
      return;
    }
    this.heading.textContent =
      `Made in frame ${record.frames[obstacles.frame]}: ${labelCounts(obstacles)}. From right to left.`;
    this.rows = obstacles.sectors.map((sector, number) => {
      const choose = button(String(number), () => this.choose(number), { 'aria-label': `choose sector ${number}` });
      choose.addEventListener('focus', () => this.state.set({ hoverSector: number }));
      choose.addEventListener('blur', () => this.state.set({ hoverSector: -1 }));
      const label = element('td', { class: 'drive-label' }, labelSwatch(sector.label, this.map.theme),
        ` ${LABEL_LOOKS[sector.label].words}`, element('span', { class: 'drive-reason' }, sector.reason));
      const row = element('tr', { 'data-drive-sector': number, 'data-label': sector.label },
        element('th', { scope: 'row' }, choose), element('td', {}, degreesOf(sector)),
        element('td', {}, sector.radius.toFixed(2)), label);
      row.addEventListener('click', () => this.choose(number));
      row.addEventListener('pointerenter', () => this.state.set({ hoverSector: number }));
      row.addEventListener('pointerleave', () => this.state.set({ hoverSector: -1 }));
      return row;
    });
    this.body.replaceChildren(...this.rows);
    // The box has no height before it is in the page.
    requestAnimationFrame(() => this.mark(true));
  }

  /** @param {number} number */
  choose(number) {
    this.state.set({ sector: number, hoverSector: -1 });
  }

  /** @param {boolean} mayScroll whether the chosen row is brought into sight */
  mark(mayScroll) {
    const { sector, hoverSector } = this.state.choice;
    this.rows.forEach((row, number) => {
      setAttributes(row, { 'aria-selected': number === sector ? 'true' : null });
      row.classList.toggle('drive-hovered', number === hoverSector);
    });
    const row = this.rows[sector];
    if (row && mayScroll) {
      // Only the table's own box scrolls, never the page.
      const top = row.offsetTop - (this.box.clientHeight - row.offsetHeight) / 2;
      this.box.scrollTo({ top: Math.max(0, top) });
    }
  }

  /** The next sector, or the one before. @param {number} way 1 or -1 */
  step(way) {
    const count = this.rows.length;
    if (count > 0) {
      const { sector } = this.state.choice;
      this.choose(sector < 0 ? (way > 0 ? 0 : count - 1) : (sector + way + count) % count);
    }
  }
}
