// Chips that filter the table of rays, each with the number of rays that it would leave.

import { button, element } from '../elements.js';
import { causeMark, classMark } from '../panel/legend.js';
import { countWords } from '../data/numbers.js';
import { CLASS_NAMES, NO_CODE } from '../data/page_model.js';
import { FACETS } from './list.js';

/** @typedef {import('./list.js').RayList} RayList */
/** @typedef {import('./list.js').Facet} Facet */
/** @typedef {import('../data/page_model.js').PageModel} PageModel */

/** Most chips of a facet. */
const MOST_CHIPS = 24;

export class Filters {
  /** @param {PageModel} model @param {RayList} rays @param {() => void} changed */
  constructor(model, rays, changed) {
    this.model = model;
    this.rays = rays;
    this.changed = changed;
    this.root = element('div', { class: 'x-filters', role: 'group', 'aria-label': 'Filters of the table' });
  }

  /** Draws the chips again, with their counts. */
  update() {
    const focused = document.activeElement?.getAttribute('data-chip');
    this.root.replaceChildren();
    for (const facet of FACETS) {
      const counts = this.rays.counts(facet);
      // Nothing to choose between.
      if (counts.size < 2 && this.rays.chosen[facet].size === 0) {
        continue;
      }
      const chips = [...counts].slice(0, MOST_CHIPS).map(([code, count]) => this.chip(facet, code, count));
      this.root.append(
        element(
          'div',
          { class: 'x-facet', role: 'group', 'aria-label': facet },
          element('span', { class: 'x-soft' }, facet),
          ...chips,
        ),
      );
    }
    if (FACETS.some((facet) => this.rays.chosen[facet].size > 0)) {
      this.root.append(button('Show all', () => this.clear(), { class: 'x-plain', 'data-chip': 'clear' }));
    }
    if (focused) {
      /** @type {HTMLElement|null} */ (this.root.querySelector(`[data-chip="${focused}"]`))?.focus();
    }
  }

  /** @param {Facet} facet @param {number} code @param {number} count */
  chip(facet, code, count) {
    const isChosen = this.rays.chosen[facet].has(code);
    const chip = button('', () => this.toggle(facet, code), {
      class: 'x-chip',
      'aria-pressed': String(isChosen),
      'data-chip': `${facet}-${code}`,
      'data-count': count,
    });
    if (facet === 'class') {
      chip.append(classMark(code));
    }
    if (facet === 'cause' && code !== NO_CODE) {
      chip.append(causeMark(code));
    }
    chip.append(codeName(this.model, this.rays, facet, code), element('small', {}, countWords(count)));
    return chip;
  }

  /** @param {Facet} facet @param {number} code */
  toggle(facet, code) {
    const set = this.rays.chosen[facet];
    if (!set.delete(code)) {
      set.add(code);
    }
    this.apply();
  }

  /** Shows the rays of one code only. @param {Facet} facet @param {number} code */
  only(facet, code) {
    FACETS.forEach((other) => this.rays.chosen[other].clear());
    this.rays.chosen[facet].add(code);
    this.apply();
  }

  clear() {
    FACETS.forEach((facet) => this.rays.chosen[facet].clear());
    this.apply();
  }

  apply() {
    this.rays.update();
    this.update();
    this.changed();
  }
}

/** @param {PageModel} model @param {RayList} rays @param {Facet} facet @param {number} code */
export function codeName(model, rays, facet, code) {
  switch (facet) {
    case 'class':
      return (model.classes ?? CLASS_NAMES)[code] ?? `class ${code}`;
    case 'cause':
      return code === NO_CODE ? 'no cause' : (model.causes?.[code]?.switches.join(' + ') ?? `cause ${code}`);
    case 'quantity':
      return model.quantities?.[code]?.name ?? 'no quantity';
    case 'sensor':
      return model.sensors[code]?.name ?? '';
    default:
      return pairName(model, rays.pairs[code]);
  }
}

/** @param {PageModel} model @param {{a: number, b: number}} pair */
export function pairName(model, pair) {
  return [pair.a, pair.b].map((side) => model.sides[side]?.name ?? '?').join(', ');
}
