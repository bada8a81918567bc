// The read-out: both sides' values of one cell, their difference, and what the judge says of it.
//
// For tests. Elements with `data-readout` have text for people, and in `data-value` the number for programs:
//   sensor, i, j            the cell
//   a, b                    recorded values: shortest decimal that gives the f32 back, "no hit" without one
//   difference              b - a in the channel's unit (of ranges: from f64, if the page has it)
//   ulps-f32, ulps-f64      steps from a to b
//   share                   |difference| / bound, of ranges
//   face-a, face-b          faces, 4294967295 for none
//   class, cause, quantity  names; `data-value` is the code, 255 for none
//   margin-face, margin-surface, margin-visibility, margin-landing
// `[data-readout-root]` has `data-channel`, `data-cell`, `data-state` ("empty", "busy", "ready", "failed").
// `[data-goto]` is the field for a cell.

import { element, valueTable } from '../elements.js';
import { causeMark, classMark } from '../panel/legend.js';
import { cellWords, plain, signedWithUnit, withUnit } from '../data/numbers.js';
import { NOTHING, CLASS_NAMES, NO_CODE } from '../data/page_model.js';
import { readCell, shareOfBound } from '../data/cell_reading.js';
import { isNamed } from '../data/channels.js';
import { recordedWords, spokenWords } from './cell_words.js';
import { axisWords } from '../panel/axis_words.js';

/** @typedef {import('../data/page_data.js').PageData} PageData */
/** @typedef {import('../data/channels.js').Channel} Channel */
/** @typedef {import('../data/cell_reading.js').CellReading} CellReading */
/** @typedef {import('../state.js').State} State */

/** Rest before a cell is told to a screen reader: milliseconds. */
const SPEAKING_REST = 500;

export class Readout {
  /**
   * @param {PageData} data @param {State} state
   * @param {(sensor: number) => Channel|null} channelOn the channel that a sensor's panel shows
   * @param {(text: string) => void} goTo
   */
  constructor(data, state, channelOn, goTo) {
    this.data = data;
    this.state = state;
    this.channelOn = channelOn;
    this.ticket = 0;
    this.timer = 0;
    this.title = element('b', { class: 'x-readout-title' }, 'No cell');
    this.field = element('input', {
      type: 'text',
      'aria-label': 'Go to cell: column, row',
      placeholder: 'i,j',
      size: 9,
      'data-goto': true,
    });
    const form = element(
      'form',
      { class: 'x-goto' },
      this.field,
      element('button', { type: 'submit' }, 'Go'),
    );
    form.addEventListener('submit', (event) => {
      event.preventDefault();
      goTo(this.field.value);
    });
    this.body = element('div', { class: 'x-readout-body' });
    this.live = element('div', { class: 'x-unseen', role: 'status', 'aria-live': 'polite' });
    this.root = element(
      'section',
      {
        class: 'x-readout x-card',
        'aria-label': 'Read-out',
        'data-readout-root': true,
        'data-state': 'empty',
      },
      element('header', {}, this.title, form),
      this.body,
      this.live,
    );
    this.empty();
  }

  empty() {
    this.title.textContent = 'Read-out';
    this.body.replaceChildren(
      element(
        'p',
        { class: 'x-soft' },
        'Point at a picture, or select a cell by a click or by the arrow keys with Shift.',
      ),
    );
    this.root.dataset.state = 'empty';
  }

  /** Reads the cell under the pointer, else the selected one. */
  async update() {
    const place = this.state.reading;
    this.ticket += 1;
    const ticket = this.ticket;
    if (!place) {
      this.empty();
      return;
    }
    const channel = this.channelOn(place.sensor);
    if (!channel) {
      return;
    }
    this.root.dataset.state = 'busy';
    const { a, b } = this.state.choice;
    try {
      const reading = await readCell(this.data, place.sensor, a, b, channel, place.cell);
      if (ticket === this.ticket) {
        this.show(place, channel, reading);
      }
    } catch (error) {
      this.root.dataset.state = 'failed';
      const words = `This cell could not be read: ${String(error)}.`;
      this.body.replaceChildren(element('p', { class: 'x-soft' }, words));
    }
  }

  /** @param {{sensor: number, cell: number}} place @param {Channel} channel @param {CellReading} reading */
  show(place, channel, reading) {
    const { model } = this.data;
    const sensor = model.sensors[place.sensor];
    const [i, j] = [place.cell % sensor.width, Math.floor(place.cell / sensor.width)];
    this.title.replaceChildren(
      readoutSpan('sensor', sensor.name, place.sensor),
      ' (',
      readoutSpan('i', String(i), i),
      ', ',
      readoutSpan('j', String(j), j),
      ')',
    );
    Object.assign(this.root.dataset, { state: 'ready', channel: channel.key, cell: String(place.cell) });
    const shown = shownChannel(channel);
    const { a, b } = this.state.choice;
    const names = [a, b].map((side) => model.sides[side]?.name ?? '?');
    const rows = [
      valueRow(shown.title, [
        valueCell('a', reading.a, reading.hasA, shown),
        valueCell('b', reading.b, reading.hasB, shown),
      ]),
    ];
    if (shown.key !== 'face.I') {
      rows.push(valueRow('face', [faceCell('face-a', reading.faceA), faceCell('face-b', reading.faceB)]));
    }
    const table = valueTable([`A ${names[0]}`, `B ${names[1]}`], rows);
    const lines = element('dl', { class: 'x-lines' });
    const { axes } = sensor;
    const ofAxes = axes
      ? `${axes.columns.name} ${axisWords(axes.columns, axes.columns.at[i])}, ` +
        `${axes.rows.name} ${axisWords(axes.rows, axes.rows.at[j])}`
      : '';
    if (ofAxes) {
      lines.append(element('dt', {}, 'direction'), element('dd', { 'data-readout': 'direction' }, ofAxes));
    }
    for (const [name, content] of this.lines(reading, shown)) {
      lines.append(element('dt', {}, name), element('dd', {}, ...content));
    }
    this.body.replaceChildren(table, lines);
    if (!this.state.choice.hover) {
      this.speak(`${sensor.name} ${i}, ${j}. ${spokenWords(reading, shown, names)}`);
    }
  }

  /** @param {CellReading} reading @param {Channel} channel @returns {[string, (Node|string)[]][]} */
  lines(reading, channel) {
    const { model } = this.data;
    /** @type {[string, (Node|string)[]][]} */
    const lines = [];
    if (!isNamed(channel.drawing) && (reading.hasA || reading.hasB)) {
      lines.push(['B − A', differenceWords(reading, channel)]);
    }
    if (reading.code !== NO_CODE) {
      const names = model.classes ?? CLASS_NAMES;
      const quantity = model.quantities?.[reading.quantity]?.name;
      const words = /** @type {(Node|string)[]} */ ([
        classMark(reading.code),
        ' ',
        readoutSpan('class', names[reading.code] ?? '?', reading.code),
      ]);
      if (quantity) {
        words.push(' by ', readoutSpan('quantity', quantity, reading.quantity));
      }
      lines.push(['class', words]);
    }
    const cause = model.causes?.[reading.cause];
    if (cause) {
      lines.push([
        'cause',
        [causeMark(reading.cause), ' ', readoutSpan('cause', cause.switches.join(' + '), reading.cause)],
      ]);
    }
    if (reading.margins) {
      const { face, surface, visibility, landing } = reading.margins;
      /** @type {(Node|string)[]} */
      const words = [];
      for (const [name, value, unit] of /** @type {[string, number, string][]} */ ([
        ['face', face, 'cells'],
        ['surface', surface, 'cells'],
        ['visibility', visibility, 'cells'],
        ['landing', landing, 'pixels'],
      ])) {
        if (!Number.isNaN(value)) {
          const text = value >= 1 ? '≥ 1' : plain(value, 3);
          words.push(
            words.length > 0 ? '; ' : '',
            `${name} `,
            readoutSpan(`margin-${name}`, text, value),
            ` ${unit}`,
          );
        }
      }
      lines.push(['margins', words]);
    }
    return lines;
  }

  /** Tells a cell when the cursor rests. @param {string} words */
  speak(words) {
    window.clearTimeout(this.timer);
    this.timer = window.setTimeout(() => {
      this.live.textContent = words;
    }, SPEAKING_REST);
  }
}

/**
 * The channel whose numbers are read out when a picture has none of a side.
 * @param {Channel} channel
 * @returns {Channel}
 */
function shownChannel(channel) {
  if (channel.drawing === 'normal') {
    return { ...channel, key: 'N.Z', title: 'normal z', drawing: 'signed' };
  }
  return channel.belongs === 'side'
    ? channel
    : { ...channel, key: 'range.T', title: 'range', unit: 'm', drawing: 'value', belongs: 'side' };
}

/** @param {string} name @param {string} text @param {number} value */
function readoutSpan(name, text, value) {
  return element('span', { 'data-readout': name, 'data-value': String(value) }, text);
}

/** @param {string} title @param {Node[]} cells */
function valueRow(title, cells) {
  return element('tr', {}, element('th', { scope: 'row' }, title), ...cells);
}

/** @param {string} name @param {number} value @param {boolean} isGiven @param {Channel} channel */
function valueCell(name, value, isGiven, channel) {
  const text = recordedWords(value, isGiven, channel);
  const unit =
    isGiven && Number.isFinite(value) && channel.unit && !isNamed(channel.drawing) ? ` ${channel.unit}` : '';
  return element('td', {}, readoutSpan(name, text, value), unit);
}

/** @param {string} name @param {number} face */
function faceCell(name, face) {
  const text = Number.isNaN(face) ? 'not given' : face === NOTHING ? 'none' : String(face);
  return element('td', {}, readoutSpan(name, text, face));
}

/** Two values of which one at least is none. @param {number} a @param {number} b */
function unlikeWords(a, b) {
  if (a !== -Infinity && b !== -Infinity) {
    return `none: ${Number.isFinite(a) ? 'A' : 'B'} has a hit, ${Number.isFinite(a) ? 'B' : 'A'} has none`;
  }
  const isHit = Number.isFinite(a) || Number.isFinite(b);
  return `too near on one side, ${isHit ? 'a hit' : 'no hit'} on the other`;
}

/** @param {CellReading} reading @param {Channel} channel @returns {(Node|string)[]} */
function differenceWords(reading, channel) {
  const { difference, singleSteps, doubleSteps } = reading;
  if (!reading.hasA || !reading.hasB) {
    return [readoutSpan('difference', `none: ${reading.hasA ? 'B' : 'A'} does not give this quantity`, NaN)];
  }
  if (Number.isNaN(difference)) {
    const words = reading.a === -Infinity ? 'too near on both sides' : 'no hit on either side';
    return [readoutSpan('difference', `none: ${words}`, NaN)];
  }
  if (!Number.isFinite(difference)) {
    return [readoutSpan('difference', unlikeWords(reading.a, reading.b), Infinity)];
  }
  if (channel.key.startsWith('pixel.')) {
    return [readoutSpan('difference', String(difference), difference), ' pixels'];
  }
  /** @type {(Node|string)[]} */
  const words = [readoutSpan('difference', signedWithUnit(difference, channel.unit, 4), difference)];
  words.push(' = ');
  if (doubleSteps !== null) {
    const most = reading.isSaturated ? 'over ' : '';
    words.push(readoutSpan('ulps-f64', `${most}${plain(doubleSteps, 10)}`, doubleSteps), ' ulp of f64, ');
  }
  words.push(readoutSpan('ulps-f32', plain(singleSteps, 10), singleSteps), ' ulp of f32');
  const share = shareOfBound(reading);
  if (!Number.isNaN(share)) {
    words.push(
      '; ',
      readoutSpan('share', cellWords(share, 5), share),
      ` of its bound ${withUnit(reading.bound, 'm', 2)}`,
    );
  }
  return words;
}
