// The picture of one sensor: layers of both sides, marks, axes, numbers in cells, and the slider's divider.

import { element } from '../elements.js';
import { Viewport } from './viewport.js';
import { drawMarks, drawSelection, marksOf } from './marks.js';
import { drawAxes, drawGrid, drawNumbers } from './drawing.js';
import { drawLayers } from './layers.js';
import { PictureHand } from './hand.js';
import { pictureDivider } from './divider.js';
import { fillLegend } from './legend.js';
import { channelOf, channelsOfSensor, isNamed } from '../data/channels.js';

/** @typedef {import('./painter.js').Painter} Painter */
/** @typedef {import('./painter.js').Layer} Layer */
/** @typedef {import('../state.js').State} State */
/** @typedef {import('../data/channels.js').Channel} Channel */
/** @typedef {{cells: Uint32Array, codes: Uint8Array}} MarkedCells */
/**
 * @typedef {object} PanelHost what a panel tells the page
 * @property {(panel: SensorPanel) => void} viewChanged
 * @property {(sensor: number, cell: number, isHover: boolean) => void} pointed
 * @property {() => void} left
 * @property {() => void} painted
 */

/** Room for the axes: CSS pixels. */
const GUTTER = { left: 40, bottom: 20, top: 4, right: 4 };
/** The same with names of the axes. */
const NAMED_GUTTER = { left: 58, bottom: 36, top: 6, right: 12 };

export class SensorPanel {
  /** @param {number} sensorIndex @param {State} state @param {Painter} painter @param {PanelHost} host */
  constructor(sensorIndex, state, painter, host) {
    this.sensorIndex = sensorIndex;
    this.state = state;
    this.painter = painter;
    this.host = host;
    this.model = painter.data.model;
    this.sensor = this.model.sensors[sensorIndex];
    this.view = new Viewport(this.sensor.width, this.sensor.height);
    this.gutter = this.sensor.axes ? NAMED_GUTTER : GUTTER;
    this.channels = channelsOfSensor(this.model, sensorIndex);
    /** @type {Layer[]} */
    this.layers = [];
    /** @type {MarkedCells} */
    this.marked = { cells: new Uint32Array(0), codes: new Uint8Array(0) };
    this.ticket = 0;
    this.isDue = false;
    this.isSeen = false;
    this.isStale = true;
    this.isSized = false;
    /** Cell to show as soon as the size is known; -1 for none. */
    this.awaited = -1;
    const { name, width, height } = this.sensor;
    this.caption = element('span', { class: 'x-soft' });
    this.message = element('p', { class: 'x-message', hidden: true });
    this.canvas = element('canvas', {
      class: 'x-canvas',
      tabindex: '0',
      role: 'application',
      'aria-roledescription': 'picture',
      'aria-label': `${name}: not drawn yet`,
      'data-panel': name,
    });
    this.divider = pictureDivider(name, state, (event) => this.place(event)[0] / this.view.width);
    this.stage = element('div', { class: 'x-stage' }, this.canvas, this.divider, this.message);
    this.legend = element('div', { class: 'x-legend' });
    this.root = element(
      'figure',
      { class: 'x-panel', 'data-sensor': name },
      element('figcaption', {}, element('b', {}, name), ` ${width} × ${height} `, this.caption),
      this.stage,
      this.legend,
    );
    const changed = () => {
      this.host.viewChanged(this);
      this.draw();
    };
    new PictureHand(this.canvas, this.view, {
      place: (event) => this.place(event),
      pointed: (x, y, isHover) => this.pointed(x, y, isHover),
      left: () => this.host.left(),
      panned: changed,
      zoomed: changed,
    });
    this.watch();
  }

  /** Follows its size, and whether anybody sees it. */
  watch() {
    const sizes = new ResizeObserver(() => this.resize());
    sizes.observe(this.stage);
    // Pictures that nobody sees are not computed.
    new IntersectionObserver(
      (entries) => {
        this.isSeen = entries[entries.length - 1].isIntersecting;
        if (this.isSeen && this.isStale) {
          this.refresh();
        }
      },
      { rootMargin: '200px' },
    ).observe(this.root);
  }

  /** Paints the picture, although nobody sees it yet. */
  wake() {
    if (!this.isSeen && this.isStale) {
      this.isSeen = true;
      this.refresh();
      this.isSeen = false;
    }
  }

  /** The area of the picture within the canvas, pixels of the device. */
  get area() {
    const ratio = this.view.ratio;
    return {
      x: this.gutter.left * ratio,
      y: this.gutter.top * ratio,
      width: this.view.width,
      height: this.view.height,
    };
  }

  /**
   * The place of a pointer within the area, pixels of the device.
   * @param {{clientX: number, clientY: number}} event
   * @returns {[number, number]}
   */
  place(event) {
    const box = this.canvas.getBoundingClientRect();
    const { area, view } = this;
    return [
      (event.clientX - box.left) * view.ratio - area.x,
      (event.clientY - box.top) * view.ratio - area.y,
    ];
  }

  /** @param {number} x @param {number} y pixels of the device within the area @param {boolean} isHover */
  pointed(x, y, isHover) {
    const { view } = this;
    const isInside = x >= 0 && y >= 0 && x < view.width && y < view.height;
    const cell = isInside ? view.cellAt(x, y) : -1;
    if (isHover || cell >= 0) {
      this.host.pointed(this.sensorIndex, cell, isHover);
    }
  }

  resize() {
    const width = this.stage.clientWidth;
    if (width === 0) {
      return;
    }
    const ratio = window.devicePixelRatio || 1;
    const across = width - this.gutter.left - this.gutter.right;
    const down = this.view.heightFor(across);
    const [canvasWidth, canvasHeight] = [width, down + this.gutter.top + this.gutter.bottom].map((side) =>
      Math.round(side * ratio),
    );
    this.canvas.style.height = `${canvasHeight / ratio}px`;
    if (this.canvas.width !== canvasWidth || this.canvas.height !== canvasHeight) {
      this.canvas.width = canvasWidth;
      this.canvas.height = canvasHeight;
    }
    this.view.resize(Math.floor(across * ratio), Math.floor(down * ratio), ratio);
    this.isSized = true;
    if (this.awaited >= 0) {
      this.goTo(this.awaited);
      this.awaited = -1;
    }
    // A canvas of another size is empty.
    this.drawNow();
  }

  /** The quantity that this panel shows: the chosen one, or range if the sensor does not have it. */
  get channel() {
    const chosen = this.channels.find((channel) => channel.key === this.state.choice.channel);
    return chosen ?? this.channels[0] ?? channelOf(this.model, 'range.T');
  }

  /** Which pictures the chosen mode needs. @param {Channel} channel @returns {Layer['of'][]} */
  wantedLayers(channel) {
    if (channel.belongs !== 'side') {
      return ['common'];
    }
    switch (this.state.choice.mode) {
      case 'a':
        return ['a'];
      case 'b':
        return ['b'];
      case 'difference':
        return ['difference'];
      default:
        return ['a', 'b'];
    }
  }

  /** @param {Layer['of']} of */
  settings(of) {
    const { exposure, isRobust, isLogOfValues, isLogOfDifferences } = this.state.choice;
    return { exposure, isRobust, isLog: of === 'difference' ? isLogOfDifferences : isLogOfValues };
  }

  /** Computes the pictures again, if somebody sees them. */
  async refresh() {
    this.isStale = true;
    if (!this.isSeen) {
      return;
    }
    this.isStale = false;
    this.ticket += 1;
    const ticket = this.ticket;
    const channel = this.channel;
    const { a, b } = this.state.choice;
    /** @type {(Layer|null)[]} */
    let layers = [];
    let trouble = '';
    try {
      if (channel) {
        layers = await Promise.all(
          this.wantedLayers(channel).map((of) =>
            this.painter.layer(this.sensorIndex, { a, b }, of, channel, this.settings(of)),
          ),
        );
      }
    } catch (error) {
      trouble = `This picture could not be made: ${error instanceof Error ? error.message : error}.`;
    }
    if (ticket !== this.ticket) {
      return;
    }
    this.layers = layers.filter((layer) => layer !== null);
    if (!trouble && this.layers.length < layers.length) {
      const sides = this.model.sides;
      const silent =
        channel && [a, b].filter((side) => !this.painter.data.has(this.sensorIndex, side, channel.key));
      const names = [...new Set(silent)].map((side) => sides[side]?.name ?? '').join(' and ');
      trouble =
        channel?.belongs === 'side'
          ? `${names || 'No side'}: ${channel.title} is not given.`
          : 'The judge did not compare these two sides.';
    }
    this.message.textContent = trouble || (channel ? '' : 'Nothing is recorded of this sensor.');
    this.message.hidden = this.message.textContent === '';
    this.describe();
    this.drawNow();
    this.host.painted();
  }

  /** Words around the picture. */
  describe() {
    const channel = this.channel;
    const { mode, a, b, flipShowsB } = this.state.choice;
    const [nameA, nameB] = [a, b].map((side) => this.model.sides[side]?.name ?? '?');
    const isCommon = channel?.belongs !== 'side';
    /** @type {Record<string, string>} */
    const sides = {
      a: nameA,
      b: nameB,
      difference: `${nameB} ${channel && isNamed(channel.drawing) ? 'against' : 'minus'} ${nameA}`,
      slider: `${nameA} | ${nameB}`,
      blend: `${nameA} + ${nameB}`,
      flip: flipShowsB ? nameB : nameA,
    };
    const title = channel?.title ?? '';
    this.caption.textContent = isCommon ? title : `${title}, ${sides[mode]}`;
    this.canvas.setAttribute(
      'aria-label',
      `${this.sensor.name}: ${this.caption.textContent}. Keys: press ? for help.`,
    );
    fillLegend(this.legend, this.model, this.layers, this.view);
  }

  draw() {
    if (!this.isDue) {
      this.isDue = true;
      requestAnimationFrame(() => {
        if (this.isDue) {
          this.drawNow();
        }
      });
    }
  }

  drawNow() {
    this.isDue = false;
    const context = this.canvas.getContext('2d');
    if (!context) {
      return;
    }
    const { area, view } = this;
    const ink = getComputedStyle(this.stage);
    context.clearRect(0, 0, this.canvas.width, this.canvas.height);
    context.save();
    context.translate(area.x, area.y);
    context.beginPath();
    context.rect(0, 0, area.width, area.height);
    context.clip();
    drawLayers(context, view, this.layers, this.state.choice, ink);
    const top = this.topLayer();
    drawGrid(context, view);
    if (top) {
      drawNumbers(context, view, top, this.layers);
    }
    if (this.state.choice.showsMarks) {
      drawMarks(context, view, marksOf(view, this.marked.cells, this.marked.codes));
    }
    const { sensor, cell } = this.state.choice;
    if (sensor === this.sensorIndex && cell >= 0) {
      drawSelection(context, view, cell);
    }
    context.restore();
    drawAxes(context, view, area, ink, this.sensor.axes ?? null);
    this.placeDivider();
    this.canvas.style.touchAction = view.isFitted ? 'pan-y' : 'none';
    const stretch = view.stretch;
    this.canvas.dataset.stretch = stretch.toFixed(2);
    this.canvas.dataset.scale = (view.scaleX / view.ratio).toFixed(3);
    this.legend
      .querySelector('[data-stretch-words]')
      ?.replaceChildren(
        stretch > 1.05
          ? `Rows are drawn ${Number(stretch.toPrecision(2))} times as high as columns are wide.`
          : '',
      );
  }

  /** The layer whose numbers are written into large cells. */
  topLayer() {
    const { mode, flipShowsB } = this.state.choice;
    if (this.layers.length < 2) {
      return this.layers[0] ?? null;
    }
    return mode === 'flip' && flipShowsB ? this.layers[1] : this.layers[0];
  }

  placeDivider() {
    const { mode, divider } = this.state.choice;
    this.divider.hidden = mode !== 'slider' || this.layers.length < 2;
    const { area, view } = this;
    this.divider.style.left = `${(area.x + divider * view.width) / view.ratio}px`;
    this.divider.style.top = `${area.y / view.ratio}px`;
    this.divider.style.height = `${view.height / view.ratio}px`;
    this.divider.setAttribute('aria-valuenow', String(Math.round(divider * 100)));
  }

  /** Shows a cell, near enough to see it. @param {number} cell */
  goTo(cell) {
    if (this.stage.clientWidth === 0 || !this.isSized) {
      this.awaited = cell;
      return;
    }
    if (!this.view.shows(cell) || this.view.scaleX < 12 * this.view.ratio) {
      this.view.centreOn(cell, 16);
      this.host.viewChanged(this);
    }
    this.draw();
  }
}
