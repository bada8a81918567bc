// The table of the rays that differ. Only rows that can be seen are elements, so it may be very long.
//
// For tests: `[data-ray-table]` has `aria-rowcount` (with the head row). Rows are `[data-row]` (place in the
// list) with `data-sensor` and `data-cell`. The selected row has `aria-selected="true"`.

import { button, element } from '../elements.js';
import { causeMark, classMark } from '../panel/legend.js';
import { signedWithUnit } from '../data/numbers.js';
import { NO_CODE } from '../data/page_model.js';
import { codeName, pairName } from './filters.js';

/** @typedef {import('./list.js').RayList} RayList */
/** @typedef {import('./list.js').RayOrder} RayOrder */
/** @typedef {import('../data/page_model.js').PageModel} PageModel */

/** Height of a row: CSS pixels, as in the style. */
const ROW_HEIGHT = 30;

/** Rows beyond those that can be seen. */
const SPARE_ROWS = 6;

/** Browsers draw no element that is much higher: CSS pixels. */
const MOST_HEIGHT = 12e6;

/** @type {[string, RayOrder|null][]} */
const COLUMNS = [
  ['sensor, cell', 'place'],
  ['class', 'class'],
  ['by', null],
  ['cause', null],
  ['B − A: range', 'range'],
  ['B − A: flux', 'flux'],
];

export class RayTable {
  /** @param {PageModel} model @param {RayList} rays @param {(row: number) => void} choose */
  constructor(model, rays, choose) {
    this.model = model;
    this.rays = rays;
    this.choose = choose;
    this.selected = -1;
    this.hasPairs = false;
    this.head = element('div', { class: 'x-row x-head', role: 'row', 'aria-rowindex': 1 });
    this.space = element('div', { class: 'x-space', role: 'presentation' });
    this.box = element(
      'div',
      { class: 'x-rows', tabindex: '0', role: 'rowgroup', 'aria-label': 'Rays' },
      this.space,
    );
    this.root = element(
      'div',
      {
        class: 'x-table',
        role: 'grid',
        'aria-label': 'Rays that do not agree',
        'data-ray-table': true,
      },
      element('div', { role: 'rowgroup' }, this.head),
      this.box,
    );
    this.box.addEventListener('scroll', () => this.draw());
    this.box.addEventListener('keydown', (event) => this.key(event));
    this.box.addEventListener('click', (event) => {
      const row = /** @type {HTMLElement} */ (event.target).closest('[data-row]')?.getAttribute('data-row');
      if (row) {
        this.pick(Number(row));
      }
    });
    new ResizeObserver(() => this.draw()).observe(this.box);
  }

  /** Fits the table to a changed list. */
  update() {
    this.hasPairs = this.rays.pairs.length > 1;
    this.root.classList.toggle('x-with-pairs', this.hasPairs);
    this.root.setAttribute('aria-rowcount', String(this.rays.shown.length + 1));
    this.space.style.height = `${Math.min(this.rays.shown.length * ROW_HEIGHT, MOST_HEIGHT)}px`;
    this.drawHead();
    this.draw();
  }

  drawHead() {
    const cells = COLUMNS.map(([title, order]) => {
      if (!order) {
        return element('span', { role: 'columnheader' }, title);
      }
      const isOrder = this.rays.order === order;
      const direction = this.rays.isDescending ? 'descending' : 'ascending';
      const sign = isOrder ? (this.rays.isDescending ? ' ↓' : ' ↑') : '';
      const sort = button(`${title}${sign}`, () => this.sort(order), {
        class: 'x-plain',
        'data-sort': order,
      });
      return element('span', { role: 'columnheader', 'aria-sort': isOrder ? direction : 'none' }, sort);
    });
    const focused = document.activeElement?.getAttribute('data-sort');
    this.head.replaceChildren(
      ...cells,
      ...(this.hasPairs ? [element('span', { role: 'columnheader' }, 'A, B')] : []),
    );
    if (focused) {
      /** @type {HTMLElement|null} */ (this.head.querySelector(`[data-sort="${focused}"]`))?.focus();
    }
  }

  /** @param {RayOrder} order */
  async sort(order) {
    const { rays } = this;
    await rays.measure();
    const ray = this.selected >= 0 ? rays.shown[this.selected] : -1;
    // Sizes begin with the largest.
    rays.isDescending = rays.order === order ? !rays.isDescending : order !== 'place';
    rays.order = order;
    rays.update();
    this.selected = ray < 0 ? -1 : rays.shown.indexOf(ray);
    this.box.scrollTop = 0;
    this.update();
  }

  /** Rows that scroll by for each pixel; more than 1 / ROW_HEIGHT if the list is too long for an element. */
  get rowsPerPixel() {
    const height = Math.min(this.rays.shown.length * ROW_HEIGHT, MOST_HEIGHT);
    return height === 0 ? 0 : this.rays.shown.length / height;
  }

  draw() {
    const count = this.rays.shown.length;
    const top = this.box.scrollTop;
    const first = Math.floor(top * this.rowsPerPixel);
    const seen = Math.ceil(this.box.clientHeight / ROW_HEIGHT) + 1;
    const from = Math.max(0, first - SPARE_ROWS);
    const to = Math.min(count, first + seen + SPARE_ROWS);
    const isExact = count * ROW_HEIGHT <= MOST_HEIGHT;
    const rows = [];
    for (let row = from; row < to; row += 1) {
      const y = isExact ? row * ROW_HEIGHT : top + (row - first) * ROW_HEIGHT;
      rows.push(this.row(row, y));
    }
    this.space.replaceChildren(...rows);
    const active = this.selected >= from && this.selected < to ? `ray-row-${this.selected}` : null;
    if (active) {
      this.box.setAttribute('aria-activedescendant', active);
    } else {
      this.box.removeAttribute('aria-activedescendant');
    }
    if (count > 0 && !this.rays.isMeasured) {
      this.rays.measure().then(() => this.draw());
    }
  }

  /** @param {number} row @param {number} y */
  row(row, y) {
    const { rays, model } = this;
    const ray = rays.shown[row];
    const sensor = model.sensors[rays.sensor[ray]];
    const cell = rays.cell[ray];
    const code = rays.class[ray];
    const cause = rays.cause[ray];
    const place = `${sensor.name} ${cell % sensor.width},${Math.floor(cell / sensor.width)}`;
    /** @param {...(Node|string)} content */
    const cellOf = (...content) => element('span', { role: 'gridcell' }, ...content);
    return element(
      'div',
      {
        class: 'x-row',
        role: 'row',
        id: `ray-row-${row}`,
        style: `top:${y}px`,
        'aria-rowindex': row + 2,
        'aria-selected': String(row === this.selected),
        'data-row': row,
        'data-sensor': rays.sensor[ray],
        'data-cell': cell,
      },
      cellOf(place),
      cellOf(classMark(code), codeName(model, rays, 'class', code)),
      cellOf(codeName(model, rays, 'quantity', rays.quantity[ray])),
      cause === NO_CODE ? cellOf('') : cellOf(causeMark(cause), codeName(model, rays, 'cause', cause)),
      cellOf(rangeWords(rays.range[ray])),
      cellOf(fluxWords(rays.flux[ray], model.flux_unit ?? 'W')),
      ...(this.hasPairs ? [cellOf(pairName(model, rays.pairs[rays.pair[ray]]))] : []),
    );
  }

  /** @param {KeyboardEvent} event */
  key(event) {
    const last = this.rays.shown.length - 1;
    const page = Math.max(1, Math.floor(this.box.clientHeight / ROW_HEIGHT) - 1);
    const step = { ArrowDown: 1, ArrowUp: -1, PageDown: page, PageUp: -page, Home: -Infinity, End: Infinity }[
      event.key
    ];
    if (step !== undefined && last >= 0) {
      this.select(Math.min(last, Math.max(0, Math.max(this.selected, step > 0 ? -1 : 0) + step)));
    } else if ((event.key === 'Enter' || event.key === ' ') && this.selected >= 0) {
      this.choose(this.selected);
    } else {
      return;
    }
    event.preventDefault();
    event.stopPropagation();
  }

  /** @param {number} row */
  pick(row) {
    this.select(row);
    this.choose(row);
  }

  /** Marks a row, and scrolls the box so that it is seen. @param {number} row */
  select(row) {
    this.selected = row;
    const perPixel = this.rowsPerPixel;
    if (row >= 0 && perPixel > 0) {
      const y = row / perPixel;
      const height = this.box.clientHeight;
      if (y < this.box.scrollTop) {
        this.box.scrollTop = y;
      } else if (y + ROW_HEIGHT > this.box.scrollTop + height) {
        this.box.scrollTop = y + ROW_HEIGHT - height;
      }
    }
    this.draw();
  }
}

/** @param {number} difference */
function rangeWords(difference) {
  if (difference === undefined || Number.isNaN(difference)) {
    return '';
  }
  return Number.isFinite(difference) ? signedWithUnit(difference, 'm', 3) : 'none';
}

/** @param {number} change @param {string} unit */
function fluxWords(change, unit) {
  return change === undefined || Number.isNaN(change) ? '' : signedWithUnit(change, unit, 3);
}
