// The key of a picture: colour bar with ticks and unit, and what other colours and hatching mean.

import { element, svgElement } from '../elements.js';
import { CLASS_LOOKS, ONE_SIDED_COLOUR, TOO_NEAR_COLOUR, causeLook, gradientOf } from './colour.js';
import { ticksOf } from '../data/limits.js';
import { CLASS_NAMES } from '../data/page_model.js';

/** @typedef {import('../data/page_model.js').PageModel} PageModel */
/** @typedef {import('./painter.js').Layer} Layer */
/** @typedef {import('../data/limits.js').ColourScale} ColourScale */
/** @typedef {import('./viewport.js').Viewport} Viewport */

/** Width of a bar beside a picture whose width is not known, and the least of one that is: CSS pixels. */
const USUAL_BAR = 500;
const LEAST_BAR = 60;

/**
 * @param {HTMLElement} legend @param {PageModel} model @param {Layer[]} layers @param {Viewport} view
 */
export function fillLegend(legend, model, layers, view) {
  const layer = layers[0];
  legend.replaceChildren();
  if (!layer) {
    return;
  }
  if (layer.scale) {
    const width = view.width / view.ratio;
    const title = layer.of === 'difference'
      ? `difference of ${layer.channel.title}${layer.unit === '°' ? ': angle' : ''}`
      : layer.channel.title;
    legend.append(colourBar(layer.scale, layer.unit, title, width));
  }
  const keys = element('div', { class: 'x-keys' });
  for (const [look, words] of keysOf(model, layer)) {
    keys.append(element('span', { class: 'x-key' }, look, words));
  }
  if (layer.scale?.isClipped) {
    keys.append(element('span', { class: 'x-key' }, CLIPPED_WORDS));
  }
  keys.append(element('span', { class: 'x-key', 'data-stretch-words': true }));
  legend.append(keys);
}

/** What is said of a scale that is clipped. */
export const CLIPPED_WORDS = 'Values beyond the ends have the colours of the ends.';

/**
 * The colours of a scale, with ticks.
 * @param {ColourScale} scale @param {string} unit @param {string} title
 * @param {number} wide width of the picture, CSS pixels; one that has no size yet gets one before anybody sees it
 */
export function colourBar(scale, unit, title, wide) {
  const width = wide > LEAST_BAR ? wide : USUAL_BAR;
  const bar = element('div', { class: 'x-bar' });
  bar.append(element('div', { class: 'x-ramp', style: `background:${gradientOf(scale.map)}` }));
  let free = -Infinity;
  for (const tick of ticksOf(scale, unit, width < 420 ? 4 : 7)) {
    const left = `left:${(100 * tick.at).toFixed(2)}%`;
    bar.append(element('i', { style: left }));
    const half = tick.label.length * 3.4;
    const middle = tick.at * Math.min(width, 560);
    if (middle - half > free) {
      bar.append(element('span', { style: left }, tick.label));
      free = middle + half + 6;
    }
  }
  const steps = {
    linear: '',
    log: 'even steps of the logarithm',
    signed: '',
    'signed-log': 'even steps of the logarithm on both sides of 0',
  }[scale.spread];
  bar.append(element('span', { class: 'x-bar-name' }, steps ? `${title}; ${steps}` : title));
  return bar;
}

/** @param {PageModel} model @param {Layer} layer @returns {[Node, string][]} */
function keysOf(model, layer) {
  /** @param {string} colour */
  const swatch = (colour) => element('b', { class: 'x-swatch', style: `background:${colour}` });
  const hatch = element('b', { class: 'x-swatch x-hatch' });
  const { drawing } = layer.channel;
  if (layer.of === 'difference') {
    const oneSided = /** @type {[Node, string]} */ ([swatch(ONE_SIDED_COLOUR), 'hit on one side only']);
    if (!layer.scale) {
      return [[swatch('#eceae4'), 'the same'], [swatch('#e69f00'), 'another'], oneSided, [hatch, 'no hit']];
    }
    return layer.statistics?.isOneSided ? [oneSided, [hatch, 'no hit']] : [[hatch, 'no hit']];
  }
  switch (drawing) {
    case 'classes': {
      const names = model.classes ?? CLASS_NAMES;
      return [
        ...names.map((name, code) => /** @type {[Node, string]} */ ([classMark(code), name])),
        [hatch, 'not compared'],
      ];
    }
    case 'causes':
      return [
        ...(model.causes ?? []).map(
          (cause, index) => /** @type {[Node, string]} */ ([causeMark(index), cause.switches.join(' + ')]),
        ),
        [hatch, 'none'],
      ];
    case 'yes-no':
      return [
        [swatch('#f2d16b'), 'seen by the camera'],
        [swatch('#3d4451'), 'not seen'],
      ];
    case 'faces':
      return [[hatch, 'no hit']];
    case 'normal':
      return [
        [swatch('#ff8080'), '+x'],
        [swatch('#80ff80'), '+y'],
        [swatch('#8080ff'), '+z'],
        [hatch, 'no hit'],
      ];
    case 'light':
      return [];
    default:
      if (layer.statistics?.isTooNear) {
        return [
          [swatch(TOO_NEAR_COLOUR), 'too near'],
          [hatch, 'no hit'],
        ];
      }
      return [[hatch, layer.channel.belongs === 'side' ? 'no hit' : 'not known']];
  }
}

/** Colour and letter of a class. @param {number} code */
export function classMark(code) {
  const look = CLASS_LOOKS[code] ?? CLASS_LOOKS[0];
  return markOf(look.colour, look.letter);
}

/** Colour and letter of a cause. @param {number} index */
export function causeMark(index) {
  const look = causeLook(index);
  return markOf(look.colour, look.letter);
}

/** @param {string} colour @param {string} letter */
function markOf(colour, letter) {
  const mark = svgElement(
    'svg',
    { class: 'x-mark', viewBox: '0 0 16 16', width: 16, height: 16, 'aria-hidden': 'true' },
    svgElement('rect', { x: 0.5, y: 0.5, width: 15, height: 15, rx: 3, fill: colour, stroke: '#00000066' }),
  );
  mark.append(
    svgElement(
      'text',
      {
        x: 8,
        y: 12,
        'text-anchor': 'middle',
        'font-size': 11,
        'font-weight': 700,
        fill: '#000000',
      },
      letter,
    ),
  );
  return mark;
}
