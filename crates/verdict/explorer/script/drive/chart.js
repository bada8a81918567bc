// Charts over time: how far the believed position is off the true one, and how many cells are known.

import { element, setAttributes, svgElement } from '../elements.js';
import { countWords } from '../data/numbers.js';
import { roundStep, tickInWords } from '../view3d/words.js';

/** @typedef {import('./state.js').DriveState} DriveState */
/** @typedef {import('./replay.js').MapReplay} MapReplay */
/** @typedef {{name: string, dash: string, values: ArrayLike<number>}} ChartLine */

/** Room for numbers at the left and below, CSS pixels. */
const CHART_LEFT = 62;
const CHART_BELOW = 30;
const CHART_RIGHT = 12;
const CHART_TOP = 8;
const CHART_HEIGHT = 150;

/** The short line before the name of a line. */
const CHART_SAMPLE = {
  class: 'drive-chart-sample', 'aria-hidden': 'true', viewBox: '0 0 26 8', width: 26, height: 8,
};

/** Dashes tell lines apart without colours. */
const CHART_DASHES = ['', '7 4', '2 3'];

class TimeChart {
  /**
   * @param {DriveState} state @param {MapReplay} replay @param {string} title @param {string} unit
   * @param {ChartLine[]} lines @param {(value: number) => string} format
   */
  constructor(state, replay, title, unit, lines, format) {
    this.state = state;
    this.record = replay.record;
    this.lines = lines;
    this.unit = unit;
    this.format = format;
    this.svg = svgElement('svg', { class: 'drive-chart', role: 'img', 'aria-label': this.summary(title) });
    this.cursor = svgElement('line', { class: 'drive-chart-cursor' });
    this.values = element('p', { class: 'drive-chart-values', 'data-drive-chart-values': unit });
    this.element = element('figure', { class: 'drive-chart-box' },
      element('figcaption', {}, title), this.svg, this.values);
    this.width = 0;
    this.isHeld = false;
    this.svg.addEventListener('pointerdown', (event) => {
      this.isHeld = event.button === 0;
      if (this.isHeld) {
        this.svg.setPointerCapture(event.pointerId);
        this.choose(event);
      }
    });
    this.svg.addEventListener('pointermove', (event) => { if (this.isHeld) { this.choose(event); } });
    for (const name of ['pointerup', 'pointercancel']) {
      this.svg.addEventListener(name, () => { this.isHeld = false; });
    }
    // The numbers stand there at once; the picture follows when its width is known.
    this.show();
    new ResizeObserver(() => this.draw()).observe(this.element);
  }

  /** @param {string} title */
  summary(title) {
    const ranges = this.lines.map(({ name, values }) => {
      const [low, high] = rangeOf([{ name, dash: '', values }]);
      return `${name} from ${this.format(low)} to ${this.format(high)}`;
    });
    return `${title}: ${ranges.join('; ')}.`;
  }

  get last() {
    return Math.max(this.record.timeOf(this.record.count - 1), 1e-9);
  }

  /** @param {number} time seconds */
  placeOf(time) {
    return CHART_LEFT + time / this.last * (this.width - CHART_LEFT - CHART_RIGHT);
  }

  /** @param {PointerEvent} event */
  choose(event) {
    const x = event.clientX - this.svg.getBoundingClientRect().left;
    const time = (x - CHART_LEFT) / (this.width - CHART_LEFT - CHART_RIGHT) * this.last;
    this.state.set({ frame: this.record.frameOfNumber(time * this.record.rate), isPlaying: false });
  }

  draw() {
    const width = Math.floor(this.element.clientWidth);
    if (width < 80 || width === this.width) { return; }
    this.width = width;
    setAttributes(this.svg, { viewBox: `0 0 ${width} ${CHART_HEIGHT}`, width, height: CHART_HEIGHT });
    let [low, high] = rangeOf(this.lines);
    const least = this.unit === 'm' ? 0.001 : 1;
    if (high - low < least) { [low, high] = [low - least, high + (this.unit === 'm' ? least : 0)]; }
    const bottom = CHART_HEIGHT - CHART_BELOW;
    const middle = (CHART_TOP + bottom) / 2;
    const y = (/** @type {number} */ value) => bottom - (value - low) / (high - low) * (bottom - CHART_TOP);
    const parts = [];
    const step = roundStep((high - low) / 2.5);
    for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k += 1) {
      const at = y(k * step);
      const kind = k === 0 ? 'drive-chart-zero' : 'drive-chart-grid';
      const word = this.unit === 'm' ? tickInWords(k * step, step) : countWords(k * step);
      parts.push(svgElement('line', { class: kind, x1: CHART_LEFT, x2: width - CHART_RIGHT, y1: at, y2: at }),
        svgElement('text', { x: CHART_LEFT - 6, y: at + 4, 'text-anchor': 'end' }, word));
    }
    const seconds = roundStep(this.last / Math.max(2, width / 130));
    for (let k = 0; k * seconds <= this.last * (1 + 1e-9); k += 1) {
      const at = this.placeOf(k * seconds);
      const line = { class: 'drive-chart-grid', x1: at, x2: at, y1: CHART_TOP, y2: bottom + 4 };
      const word = tickInWords(k * seconds, seconds);
      parts.push(svgElement('line', line));
      if (at < width - 48) {
        parts.push(svgElement('text', { x: at, y: bottom + 16, 'text-anchor': 'middle' }, word));
      }
    }
    parts.push(svgElement('text', { x: width - CHART_RIGHT, y: bottom + 16, 'text-anchor': 'end' }, 'time, s'),
      svgElement('text', { x: 12, y: middle, 'text-anchor': 'middle', transform: `rotate(-90 12 ${middle})` },
        this.unit === 'm' ? 'difference, m' : 'cells'));
    this.lines.forEach(({ values, dash }, index) => {
      const points = Array.from(values, (value, frame) => (
        `${this.placeOf(this.record.timeOf(frame)).toFixed(1)} ${y(value).toFixed(1)}`));
      parts.push(linePath(index, dash, `M${points.join('L')}`));
    });
    setAttributes(this.cursor, { y1: CHART_TOP, y2: bottom });
    this.svg.replaceChildren(...parts, this.cursor);
    this.show();
  }

  show() {
    const { frame } = this.state.choice;
    const x = this.placeOf(this.record.timeOf(frame));
    setAttributes(this.cursor, { x1: x, x2: x });
    this.values.replaceChildren(...this.lines.map(({ name, values, dash }, index) => element('span', {},
      svgElement('svg', CHART_SAMPLE, linePath(index, dash, 'M0 4H26')),
      ` ${name} ${this.format(values[frame])}`)));
  }
}

/** @param {number} index of the line @param {string} dash @param {string} path */
function linePath(index, dash, path) {
  const look = `drive-chart-line drive-chart-line-${index}`;
  return svgElement('path', { class: look, d: path, 'stroke-dasharray': dash || null });
}

/** @param {ChartLine[]} lines @returns {[number, number]} */
function rangeOf(lines) {
  let [low, high] = [Infinity, -Infinity];
  for (const { values } of lines) {
    for (let k = 0; k < values.length; k += 1) {
      low = Math.min(low, values[k]);
      high = Math.max(high, values[k]);
    }
  }
  return low <= high ? [low, high] : [0, 1];
}

/** @param {number} value metres */
function millimetres(value) {
  return `${(1000 * value).toFixed(1).replace('-', '−')} mm`;
}

/** The two charts. @param {DriveState} state @param {MapReplay} replay */
export function driveCharts(state, replay) {
  const { record, known } = replay;
  const differences = ['x', 'y', 'z'].map((name, axis) => ({
    name, dash: CHART_DASHES[axis],
    values: Float64Array.from({ length: record.count }, (_, frame) => (
      record.believed[7 * frame + axis] - record.stance[7 * frame + axis])),
  }));
  const all = Float64Array.from(known[0], (count, frame) => count + known[1][frame] + known[2][frame]);
  const cells = [{ name: 'known', dash: '', values: all }, { name: 'measured', dash: '7 4', values: known[2] }];
  const charts = [
    new TimeChart(state, replay, 'Believed minus true position', 'm', differences, millimetres),
    new TimeChart(state, replay, 'Known cells of the elevation map', '', cells, countWords),
  ];
  state.listen((changed) => { if (changed.has('frame')) { charts.forEach((chart) => chart.show()); } });
  const boxes = charts.map((chart) => chart.element);
  return element('div', { class: 'drive-charts', 'data-drive-charts': true }, ...boxes);
}
