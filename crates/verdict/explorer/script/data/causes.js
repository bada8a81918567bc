// The causes, one card each: what the paper does, a sketch, where it happened, what it cost, and a filter.
//
// For tests: cards are `[data-cause]` (index of the cause), with `[data-cause-rays]` and a button
// `[data-cause-filter]`.

import { button, element } from '../elements.js';
import { causeMark } from '../panel/legend.js';
import { causeLook } from '../panel/colour.js';
import { counted, countWords, withUnit } from './numbers.js';
import { placeWords } from './page_model.js';
import { hashOfCell } from './page_hash.js';
import { sketchOf } from '../panel/sketches.js';

/** @typedef {import('./page_model.js').PageModel} PageModel */
/** @typedef {import('./page_model.js').CauseModel} CauseModel */
/** @typedef {import('../rays/list.js').RayList} RayList */
/**
 * @typedef {{filter: (cause: number) => void, goTo: (sensor: number, cell: number, ray: number) => void}}
 *   CauseActions
 */

/** Size of a map of places: squares across and, at most, down. */
const MAP_ACROSS = 64;

/**
 * @param {PageModel} model @param {RayList} rays @param {CauseActions} actions
 */
export function causeCards(model, rays, actions) {
  const cards = (model.causes ?? []).map((cause, index) => causeCard(model, rays, actions, cause, index));
  return element('div', { class: 'x-causes' }, ...cards);
}

/**
 * @param {PageModel} model @param {RayList} rays @param {CauseActions} actions @param {CauseModel} cause
 * @param {number} index
 */
function causeCard(model, rays, actions, cause, index) {
  const card = element(
    'section',
    { class: 'x-card x-cause', 'data-cause': index },
    element('h3', {}, causeMark(index), ' ', element('code', {}, cause.switches.join(' + '))),
  );
  const facts = [
    element('b', { 'data-cause-rays': true }, counted(cause.rays ?? 0, 'ray')),
    ...(cause.lost === undefined
      ? []
      : [`; ${counted(cause.lost, 'hit')} lost, ${countWords(cause.added ?? 0)} added`]),
  ];
  if (cause.worst_range !== null && cause.worst_range !== undefined) {
    facts.push(`; ranges off by up to ${withUnit(cause.worst_range, 'm', 3)}`);
    const place = cause.worst_place;
    if (place) {
      const link = element(
        'a',
        { href: hashOfCell(model, place.sensor, place.cell) },
        placeWords(model, place.sensor, place.cell),
      );
      facts.push(' at ', link);
    }
  }
  if (cause.flux_changed) {
    facts.push(`; ${withUnit(cause.flux_changed, model.flux_unit ?? 'W', 3)} of light changed`);
  }
  card.append(element('p', {}, ...facts, '.'));
  for (const name of cause.switches) {
    const words = model.switches?.[name];
    const sketch = sketchOf(name);
    const part = element('div', { class: 'x-switch' });
    if (sketch) {
      part.append(sketch);
    }
    part.append(
      element(
        'p',
        {},
        element('b', {}, words ? sentenceCase(words.title) : name),
        words ? `. ${words.words}` : '',
      ),
    );
    card.append(part);
  }
  for (const sensor of model.sensors.keys()) {
    const map = placesMap(model, rays, actions, sensor, index);
    if (map) {
      card.append(map);
    }
  }
  card.append(
    button('Show these rays in the table', () => actions.filter(index), { 'data-cause-filter': true }),
  );
  return card;
}

/**
 * Where a cause changed rays of a sensor. A click goes to the nearest of them.
 * @param {PageModel} model @param {RayList} rays @param {CauseActions} actions @param {number} sensorIndex
 * @param {number} cause
 */
function placesMap(model, rays, actions, sensorIndex, cause) {
  const { width, height, name } = model.sensors[sensorIndex];
  /** @type {number[]} */
  const own = [];
  for (let ray = 0; ray < rays.count; ray += 1) {
    if (rays.sensor[ray] === sensorIndex && rays.cause[ray] === cause) {
      own.push(ray);
    }
  }
  if (own.length === 0) {
    return null;
  }
  const across = Math.min(MAP_ACROSS, width);
  const down = Math.max(4, Math.min(height, Math.round((across * height) / width)));
  const counts = new Float64Array(across * down);
  for (const ray of own) {
    const [i, j] = [rays.cell[ray] % width, Math.floor(rays.cell[ray] / width)];
    counts[Math.floor((j * down) / height) * across + Math.floor((i * across) / width)] += 1;
  }
  const most = Math.max(...counts);
  const canvas = element('canvas', {
    width: across,
    height: down,
    class: 'x-places',
    tabindex: '0',
    role: 'button',
    'aria-label': `${name}: where these ${countWords(own.length)} rays are. Goes to the first of them.`,
    style: `aspect-ratio:${across}/${Math.max(down, across / 12)}`,
  });
  const context = canvas.getContext('2d');
  if (context) {
    context.fillStyle = causeLook(cause).colour;
    counts.forEach((count, square) => {
      if (count > 0) {
        context.globalAlpha = 0.35 + (0.65 * Math.log1p(count)) / Math.log1p(most);
        context.fillRect(square % across, Math.floor(square / across), 1, 1);
      }
    });
  }
  /** @param {number} x @param {number} y cells */
  const nearest = (x, y) =>
    own.reduce((best, ray) => {
      /** @param {number} one */
      const distance = (one) => {
        const [i, j] = [rays.cell[one] % width, Math.floor(rays.cell[one] / width)];
        return Math.abs(i - x) / width + Math.abs(j - y) / height;
      };
      return distance(ray) < distance(best) ? ray : best;
    });
  canvas.addEventListener('click', (event) => {
    const box = canvas.getBoundingClientRect();
    const ray = nearest(
      ((event.clientX - box.left) / box.width) * width,
      ((event.clientY - box.top) / box.height) * height,
    );
    actions.goTo(sensorIndex, rays.cell[ray], ray);
  });
  canvas.addEventListener('keydown', (event) => {
    if (event.key === 'Enter' || event.key === ' ') {
      event.preventDefault();
      actions.goTo(sensorIndex, rays.cell[own[0]], own[0]);
    }
  });
  return element(
    'figure',
    {},
    canvas,
    element('figcaption', { class: 'x-soft' }, `${name}: ${counted(own.length, 'ray')}`),
  );
}

/** @param {string} text */
function sentenceCase(text) {
  return text.charAt(0).toUpperCase() + text.slice(1);
}
