// One ray in full: the verdict in words, all values of both sides, the command, and what `probe` prints.
//
// For tests: `[data-detail]` has `data-sensor` and `data-cell`. In it are `[data-detail-verdict]`,
// `[data-detail-command]`, `[data-detail-probe]` (absent if the ray is not described), rows
// `[data-detail-channel="range.T"]`, and the buttons `[data-show-3d]` and `[data-copy-command]`.

import { button, copyText, element, valueTable } from '../elements.js';
import { causeMark, classMark } from '../panel/legend.js';
import { NOTHING, NO_CODE, placeWords, probeCommand } from '../data/page_model.js';
import { plain, signedWithUnit, withUnit } from '../data/numbers.js';
import { channelOf, channelsOfSensor, isNamed } from '../data/channels.js';
import { readCell } from '../data/cell_reading.js';
import { recordedWords } from './cell_words.js';
import { commandOf, probeElement } from './probe_text.js';

/** @typedef {import('../data/page_data.js').PageData} PageData */
/** @typedef {import('../data/page_model.js').DescribedRay} DescribedRay */
/** @typedef {import('../data/cell_reading.js').CellReading} CellReading */

/** What each class says, in the order of the classes. */
const CLASS_WORDS = [
  'Both sides give the same answer within its bound.',
  'The ray meets several faces at exactly the same point, and each side names one of them. Both are right.',
  'An answer is not exact, but it is the exact answer of a ray that is displaced by no more than rounding. ' +
    'The referee has found that ray.',
  'One side makes an error of the paper, and the referee confirms the cause.',
  'The referee could not tell which side is right.',
  'No rounding and no approximation of the paper explains this answer. It is wrong.',
];

/** The channel of a quantity that is not the hit itself. @type {Record<string, string>} */
const CHANNEL_OF_QUANTITY = {
  depth: 'depth.Z',
  incidence: 'incidence.V',
  visible: 'visible.V',
  pixel: 'pixel.I',
  'pencil flux': 'flux.V',
  'pixel flux': 'flux.V',
};

/** What the last class says on pages that know less. @type {Record<string, string>} */
const LAST_CLASS_WORDS = {
  diff: 'The recordings are not the same here. Nothing on this page says which of them is right.',
  cast: 'No rounding explains this answer. It is wrong.',
};

/** @param {string} kind of the page @param {number} code */
function classWords(kind, code) {
  const isLast = code === CLASS_WORDS.length - 1;
  return (isLast ? LAST_CLASS_WORDS[kind] : undefined) ?? CLASS_WORDS[code];
}

export class RayDetail {
  /**
   * @param {PageData} data
   * @param {{showPicture: () => void, showGeometry: (() => void)|null, step: (by: number) => void}} actions
   */
  constructor(data, actions) {
    this.data = data;
    this.actions = actions;
    this.ticket = 0;
    this.root = element('section', {
      class: 'x-detail x-card',
      'aria-label': 'The selected ray',
      'data-detail': true,
      hidden: true,
    });
  }

  hide() {
    this.ticket += 1;
    this.root.hidden = true;
  }

  /** @param {number} sensor @param {number} cell @param {number} a @param {number} b */
  async show(sensor, cell, a, b) {
    this.ticket += 1;
    const ticket = this.ticket;
    const { data } = this;
    const { model } = data;
    const range = channelOf(model, 'range.T');
    const found = data.pairOf(sensor, a, b);
    if (!range) {
      return;
    }
    const [reading, described, rows] = await Promise.all([
      readCell(data, sensor, a, b, range, cell),
      data.describedRays(),
      this.valueRows(sensor, cell, a, b),
    ]);
    const ray = found ? (described.get(`${sensor}/${cell}/${found.index}`) ?? null) : null;
    if (ticket !== this.ticket) {
      return;
    }
    const names = [a, b].map((side) => model.sides[side]?.name ?? '?');
    const apart = await this.apartWords(reading, [sensor, cell, a, b], names);
    if (ticket !== this.ticket) {
      return;
    }
    const command = (ray && commandOf(ray.text)) || probeCommand(model, sensor, cell);
    /** @type {HTMLElement[]} */
    const parts = [
      element(
        'h3',
        {},
        ...(reading.code === NO_CODE ? [] : [classMark(reading.code), ' ']),
        placeWords(model, sensor, cell),
      ),
      element('p', { 'data-detail-verdict': true }, verdictWords(reading, names, apart, model.kind)),
      ...this.causeLines(reading),
      ...exactLines(ray),
      this.buttons(command),
    ];
    if (command) {
      parts.push(
        element('p', { class: 'x-soft' }, element('code', { 'data-detail-command': true }, command)),
      );
    }
    const table = valueTable([`A ${names[0]}`, `B ${names[1]}`, 'B − A'], rows);
    parts.push(
      element(
        'details',
        { open: true },
        element('summary', {}, 'Every recorded value'),
        element('div', { class: 'x-scroll' }, table),
      ),
    );
    if (ray) {
      parts.push(
        element(
          'details',
          { open: true, 'data-detail-probe': true },
          element('summary', {}, 'What ', element('code', {}, model.kind === 'cast' ? 'cast' : 'probe'), ' says'),
          probeElement(ray.text),
        ),
      );
    } else if (reading.code !== NO_CODE && command) {
      parts.push(
        element(
          'p',
          { class: 'x-soft' },
          'This page does not describe this ray further. The command prints everything.',
        ),
      );
    }
    this.root.dataset.sensor = String(sensor);
    this.root.dataset.cell = String(cell);
    this.root.replaceChildren(...parts);
    this.root.hidden = false;
  }

  /**
   * What the sides say of the quantity that decides.
   * @param {CellReading} reading @param {[number, number, number, number]} where sensor, cell, both sides
   * @param {string[]} names
   */
  async apartWords(reading, where, names) {
    const { data } = this;
    const quantity = data.model.quantities?.[reading.quantity]?.name ?? '';
    const channel = channelOf(data.model, CHANNEL_OF_QUANTITY[quantity] ?? '');
    if (!channel) {
      const isApart = Number.isFinite(reading.difference) && reading.difference !== 0;
      return isApart ? ` Their ranges differ by ${withUnit(Math.abs(reading.difference), 'm', 3)}.` : '';
    }
    const [sensor, cell, a, b] = where;
    const found = await readCell(data, sensor, a, b, channel, cell);
    const said = [
      [found.a, found.hasA],
      [found.b, found.hasB],
    ].map(([value, isGiven], side) => {
      const words = recordedWords(Number(value), Boolean(isGiven), channel);
      const unit = channel.unit && Number.isFinite(Number(value)) ? ` ${channel.unit}` : '';
      return `${words}${unit} by ${names[side]}`;
    });
    return ` What is not the same is the ${quantity}: ${said.join(', ')}.`;
  }

  /** @param {string} command */
  buttons(command) {
    const row = element(
      'div',
      { class: 'x-buttons' },
      button('Previous', () => this.actions.step(-1), { title: 'Key p' }),
      button('Next', () => this.actions.step(1), { title: 'Key n' }),
      button('Show in the picture', this.actions.showPicture),
    );
    if (this.actions.showGeometry) {
      row.append(button('Show in 3-D', this.actions.showGeometry, { 'data-show-3d': true }));
    }
    if (command) {
      const copy = button(
        'Copy the command',
        async () => {
          copy.textContent = (await copyText(command)) ? 'Copied' : 'Not copied';
          window.setTimeout(() => {
            copy.textContent = 'Copy the command';
          }, 1500);
        },
        { 'data-copy-command': true },
      );
      row.append(copy);
    }
    return row;
  }

  /** @param {CellReading} reading */
  causeLines(reading) {
    const { causes, switches } = this.data.model;
    const cause = causes?.[reading.cause];
    if (!cause) {
      return [];
    }
    const titles = cause.switches.map((name) => switches?.[name]?.title ?? name);
    return [
      element(
        'p',
        {},
        causeMark(reading.cause),
        ' ',
        element('b', {}, cause.switches.join(' + ')),
        `: ${titles.join('; ')}.`,
      ),
    ];
  }

  /**
   * A row for each channel.
   * @param {number} sensor
   * @param {number} cell
   * @param {number} a
   * @param {number} b
   */
  async valueRows(sensor, cell, a, b) {
    const { data } = this;
    const channels = channelsOfSensor(data.model, sensor)
      .filter((channel) => channel.belongs === 'side' && channel.drawing !== 'normal')
      .sort((one, other) => (one.key === 'face.I' ? -1 : other.key === 'face.I' ? 1 : 0));
    return Promise.all(
      channels.map(async (channel) => {
        const reading = await readCell(data, sensor, a, b, channel, cell);
        const cells = [
          [reading.a, reading.hasA],
          [reading.b, reading.hasB],
        ].map(([value, isGiven]) =>
          element('td', {}, recordedWords(Number(value), Boolean(isGiven), channel)),
        );
        const difference = reading.difference;
        const isOfBoth = reading.hasA && reading.hasB;
        const ofNames = isOfBoth && isNamed(channel.drawing);
        const text = ofNames
          ? reading.a === reading.b
            ? 'the same'
            : 'another'
          : isOfBoth && Number.isFinite(difference)
            ? signedWithUnit(difference, channel.unit, 3)
            : '';
        return element(
          'tr',
          { 'data-detail-channel': channel.key },
          element('th', { scope: 'row' }, channel.title + (channel.unit ? `, ${channel.unit}` : '')),
          ...cells,
          element('td', {}, text),
        );
      }),
    );
  }
}

/** @param {CellReading} reading @param {string[]} names @param {string} apart @param {string} kind of the page */
function verdictWords(reading, names, apart, kind) {
  const faces = [reading.faceA, reading.faceB].map((face) =>
    Number.isNaN(face) ? 'names no face' : face === NOTHING ? 'hits nothing' : `hits face ${face}`,
  );
  const both =
    faces[0] === faces[1] && !Number.isNaN(reading.faceA)
      ? `Both sides say: ${faces[0].replace('hits', 'hit')}.`
      : `${names[0]} ${faces[0]}, ${names[1]} ${faces[1]}.`;
  const words = classWords(kind, reading.code);
  return `${both}${apart}${words ? ` ${words}` : ''}`;
}

/** @param {DescribedRay|null} ray */
function exactLines(ray) {
  const exact = ray?.exact;
  if (!ray || !exact) {
    return [];
  }
  const face =
    exact.faces.length === 0
      ? 'hits nothing'
      : exact.faces.length === 1
        ? `hits face ${exact.faces[0]}`
        : `meets the faces ${exact.faces.join(', ')} at one point`;
  const range = exact.range === null ? '' : ` at ${plain(exact.range, 10)} m`;
  const seen =
    exact.visible === null
      ? ''
      : exact.visible
        ? ' The camera sees that point'
        : ' The camera does not see that point';
  const pixel = exact.visible && exact.pixel ? `, in pixel ${exact.pixel[0]}, ${exact.pixel[1]}` : '';
  const lines = [element('p', {}, `Exactly, the ray ${face}${range}.${seen}${pixel}${seen ? '.' : ''}`)];
  const found = [ray.witness?.face, ray.witness?.surface, ray.witness?.visibility].find((one) => one);
  if (found) {
    const size = Math.max(Math.abs(found[0]), Math.abs(found[1]));
    lines.push(
      element('p', {}, `A ray that is displaced by ${plain(size, 3)} of a cell has another exact answer.`),
    );
  }
  return lines;
}
