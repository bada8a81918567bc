// The explorer: pictures, read-out, table and detail of rays, causes and geometry, tied together.

import { button, element } from './elements.js';
import { PageData } from './data/page_data.js';
import { channelsOfModel } from './data/channels.js';
import { Painter } from './panel/painter.js';
import { PLAIN_DRAWING, State } from './state.js';
import { PanelSet } from './panel/set.js';
import { Toolbar } from './panel/toolbar.js';
import { Readout } from './rays/readout.js';
import { RayList } from './rays/list.js';
import { Filters } from './rays/filters.js';
import { RayTable } from './rays/table.js';
import { RayDetail } from './rays/detail.js';
import { causeCards } from './data/causes.js';
import { downloadText, raysAsCsv } from './rays/csv.js';
import { countWords, counted } from './data/numbers.js';
import { choiceOfHash, hashOfChoice } from './data/page_hash.js';
import { Keyboard, helpDialog } from './keyboard.js';
import { EXPLORER_HELP, explorerKeys } from './explorer_keys.js';
import { Geometry } from './panel/geometry.js';
import { CloudView } from './cloud/view.js';

/** @typedef {import('./data/page_model.js').PageModel} PageModel */
/** @typedef {import('./data/container.js').Container} Container */
/** @typedef {import('./state.js').Choice} Choice */

/** Time that each side is shown in a flip: milliseconds. */
const FLIP_TIME = 700;

/** Sensors so many times as wide as high get the whole width of the page. */
const FLAT_SHAPE = 8;

/** Time to wait for the first picture before the rest of the page is filled: milliseconds. */
const LONGEST_WAIT = 2500;

/**
 * Choices after which pictures are computed again; after the others they are only drawn.
 * @type {(keyof Choice)[]}
 */
const PICTURE_CHOICES = [
  'channel',
  'mode',
  'a',
  'b',
  'exposure',
  'isRobust',
  'isLogOfValues',
  'isLogOfDifferences',
];

export class Explorer {
  /** @param {PageModel} model @param {Container} container @param {HTMLElement} root */
  constructor(model, container, root) {
    this.model = model;
    this.root = root;
    this.data = new PageData(model, container);
    this.painter = new Painter(this.data);
    this.channels = channelsOfModel(model);
    this.plain = plainChoice(
      model,
      this.channels.map(({ key }) => key),
    );
    this.state = new State({ ...this.plain, ...openingChoice(model, this.plain, this.channels) });
    this.rays = new RayList(this.data);
    this.pictures = new PanelSet(model, this.state, this.painter, () => this.painted());
    /** Whether the first picture is there. All else waits for it. */
    this.isPainted = false;
    /** @type {() => void} */
    this.beginRest = () => {};
    this.toolbar = new Toolbar(model, this.state, this.channels, {
      zoom: (factor) => this.pictures.zoom(factor),
      fit: () => this.pictures.fit(),
      help: () => this.help.showModal(),
      isLog: () => this.pictures.active.layers[0]?.scale?.spread.endsWith('log') ?? false,
    });
    this.readout = new Readout(
      this.data,
      this.state,
      (sensor) => this.pictures.panels[sensor]?.channel ?? null,
      (text) => this.goToText(text),
    );
    this.geometry = model.mesh && model.mesh.faces ? new Geometry(this.data) : null;
    this.cloud = model.solid
      ? new CloudView(this.data, this.state, this.painter, model.solid, {
          channels: this.channels,
          settings: (of) => this.pictures.chosen.settings(of),
        })
      : null;
    this.detail = new RayDetail(this.data, {
      showPicture: () => this.pictures.showSelected(),
      step: (by) => this.step(by),
      showGeometry: this.geometry ? () => this.showGeometry() : null,
    });
    this.filters = new Filters(model, this.rays, () => this.listChanged());
    this.table = new RayTable(model, this.rays, (row) => this.chooseRow(row));
    const keys = explorerKeys(this);
    this.help = helpDialog('Pictures: mouse and keys', EXPLORER_HELP, keys);
    this.keyboard = new Keyboard(root, keys);
    this.timer = 0;
    this.listWords = element(
      'p',
      { class: 'x-soft', 'data-ray-words': true },
      'Looking for rays that do not agree …',
    );
    this.list = element(
      'section',
      { class: 'x-card x-list', 'aria-label': 'Rays that do not agree' },
      element('h3', {}, 'Rays that do not agree'),
      this.listWords,
    );
    this.causes = element('section', { class: 'x-causes-box', hidden: true });
    this.build();
    this.state.listen((changed) => this.changed(changed));
    window.addEventListener('hashchange', () => this.followHash());
    // Colours of the page changed: hatching and axes take theirs from it.
    window
      .matchMedia('(prefers-color-scheme: dark)')
      .addEventListener('change', () => this.pictures.panels.forEach((panel) => panel.draw()));
  }

  build() {
    const maps = element('div', { class: 'x-maps' }, ...this.pictures.panels.map((panel) => panel.root));
    const side = element('div', { class: 'x-side' }, this.readout.root, this.list, this.detail.root);
    const isFlat = this.model.sensors.every(({ width, height }) => width > FLAT_SHAPE * height);
    const main = element('div', { class: isFlat ? 'x-main x-flat' : 'x-main' }, maps, side);
    this.root.replaceChildren(
      element('h2', {}, 'Maps and rays'),
      // The toolbar stays in sight as long as a part of this element is.
      element('div', {}, this.toolbar.root, this.toolbar.words, main),
      this.causes,
      ...(this.cloud ? [this.cloud.root] : []),
      ...(this.geometry ? [this.geometry.root] : []),
      this.help,
    );
    this.root.classList.add('x-explorer');
  }

  /** Fills the table when the first pictures are there. */
  async start() {
    const first = new Promise((resolve) => {
      this.beginRest = () => resolve(null);
      // The pictures may all be out of sight.
      window.setTimeout(resolve, LONGEST_WAIT);
    });
    this.followHash();
    await first;
    this.isPainted = true;
    this.showDetail();
    this.readout.update();
    this.pictures.paintLater();
    await this.rays.gather();
    const { rays } = this;
    const isCompared = this.model.sensors.some((sensor) => (sensor.pairs ?? []).some((pair) => pair.class));
    if (!isCompared) {
      this.list.hidden = true;
      return;
    }
    if (rays.count === 0) {
      this.listWords.textContent = 'There are none: every ray that was compared agrees.';
      return;
    }
    const save = button(
      'Save as CSV',
      async () => {
        await rays.measure();
        downloadText(
          `${this.model.title.replace(/[^\w.-]+/g, '_') || 'rays'}-rays.csv`,
          raysAsCsv(this.model, rays),
        );
      },
      { 'data-save-csv': true },
    );
    this.list.append(this.filters.root, this.table.root, element('div', { class: 'x-buttons' }, save));
    if ((this.model.causes ?? []).length > 0) {
      this.causes.replaceChildren(
        element('h2', {}, 'Causes of the differences'),
        causeCards(this.model, rays, {
          filter: (cause) => this.filterCause(cause),
          goTo: (sensor, cell, ray) => this.goToRay(sensor, cell, ray),
        }),
      );
      this.causes.hidden = false;
    }
    this.filters.update();
    this.listChanged();
  }

  /** A picture was made. The mark is for people who measure how long that takes. */
  painted() {
    if (performance.getEntriesByName('first-picture').length === 0) {
      performance.mark('first-picture');
    }
    this.toolbar?.update();
    this.beginRest?.();
  }

  /** @param {Set<keyof Choice>} changed */
  changed(changed) {
    const isNew = PICTURE_CHOICES.some((key) => changed.has(key));
    const isOnlyHover = changed.size === 1 && changed.has('hover');
    if (isNew) {
      this.pictures.panels.forEach((panel) => panel.refresh());
      this.cloud?.refresh();
    } else if (!isOnlyHover) {
      this.pictures.panels.forEach((panel) => panel.draw());
    }
    if (changed.has('flipShowsB')) {
      this.pictures.panels.forEach((panel) => panel.describe());
    }
    if (changed.has('a') || changed.has('b')) {
      this.pictures.mark(this.rays);
    }
    if (changed.has('mode') || changed.has('flipRuns')) {
      this.runFlip();
    }
    const keys = /** @type {(keyof Choice)[]} */ (['sensor', 'cell', 'a', 'b', 'channel', 'mode']);
    if (keys.some((key) => changed.has(key)) && this.state.choice.cell >= 0) {
      history.replaceState(null, '', hashOfChoice(this.model, this.state.choice, this.plain));
    }
    if (['sensor', 'cell', 'a', 'b'].some((key) => changed.has(/** @type {keyof Choice} */ (key)))) {
      this.showDetail();
    }
    if (changed.has('isLinked') && this.state.choice.isLinked) {
      this.pictures.follow(this.pictures.active);
    }
    if (!isOnlyHover) {
      this.toolbar.update();
    }
    if (this.isPainted) {
      this.readout.update();
    }
  }

  /** @param {number} by */
  stepSensor(by) {
    const count = this.pictures.panels.length;
    const sensor = (this.pictures.active.sensorIndex + by + count) % count;
    this.state.set({ sensor, cell: -1, hover: null });
    this.pictures.chosen.canvas.focus({ preventScroll: true });
    this.pictures.showSelected();
  }

  /** @param {number} by */
  stepChannel(by) {
    const keys = this.channels.map(({ key }) => key);
    const at = keys.indexOf(this.state.choice.channel) + by;
    this.state.set({ channel: keys[(at + keys.length) % keys.length] });
  }

  /** @param {string} text `i,j` or an address */
  goToText(text) {
    const numbers = text.match(/\d+/g);
    const asked = choiceOfHash(this.model, text.trim());
    const { width, height } = this.pictures.chosen.sensor;
    if (asked) {
      this.state.set({ ...asked, hover: null });
    } else if (numbers && numbers.length >= 2 && Number(numbers[0]) < width && Number(numbers[1]) < height) {
      this.state.set({ cell: Number(numbers[1]) * width + Number(numbers[0]), hover: null });
    } else {
      return;
    }
    this.pictures.showSelected();
  }

  followHash() {
    const asked = choiceOfHash(this.model, window.location.hash);
    if (asked) {
      const isKnown = this.channels.some(({ key }) => key === asked.channel);
      this.state.set({ ...asked, channel: isKnown ? asked.channel : this.state.choice.channel, hover: null });
      this.pictures.showSelected();
    }
  }

  async showGeometry() {
    const { sensor, cell, a, b } = this.state.choice;
    const pair = this.data.pairOf(sensor, a, b)?.index ?? null;
    const described = await this.data.describedRays();
    const ray = described.get(`${sensor}/${cell}/${pair ?? 0}`) ?? null;
    this.geometry?.open();
    this.geometry?.root.scrollIntoView({ block: 'start' });
    await this.geometry?.showRay({ sensor, cell, pair, ray });
  }

  showDetail() {
    if (!this.isPainted) {
      return;
    }
    const { sensor, cell, a, b } = this.state.choice;
    if (cell < 0) {
      this.detail.hide();
      return;
    }
    this.detail.show(sensor, cell, a, b);
    this.table.select(this.rays.placeOf(sensor, cell, a, b));
  }

  /** @param {number} row of the table */
  chooseRow(row) {
    const ray = this.rays.shown[row];
    this.goToRay(this.rays.sensor[ray], this.rays.cell[ray], ray);
  }

  /** @param {number} sensor @param {number} cell @param {number} ray */
  goToRay(sensor, cell, ray) {
    const pair = this.rays.pairs[this.rays.pair[ray]];
    const { a, b } = this.state.choice;
    const isPair = (pair.a === a && pair.b === b) || (pair.a === b && pair.b === a);
    this.state.set({ sensor, cell, hover: null, ...(isPair ? {} : pair) });
    this.pictures.showSelected();
  }

  /** To the next ray of the table. @param {number} by */
  step(by) {
    const count = this.rays.shown.length;
    if (count > 0) {
      const from = this.table.selected >= 0 ? this.table.selected : by > 0 ? -1 : 0;
      const row = (from + by + count) % count;
      this.table.select(row);
      this.chooseRow(row);
    }
  }

  /** @param {number} cause */
  filterCause(cause) {
    this.filters.only('cause', cause);
    this.list.scrollIntoView({ block: 'start' });
    this.table.box.focus({ preventScroll: true });
  }

  /** The list has other rays. */
  listChanged() {
    const { shown, count } = this.rays;
    const { sensor, cell, a, b } = this.state.choice;
    const words =
      shown.length === count
        ? counted(count, 'ray')
        : `${countWords(shown.length)} of ${counted(count, 'ray')}`;
    this.listWords.textContent = `${words}. ${this.model.rays_words ?? ''}`;
    this.table.selected = cell >= 0 ? this.rays.placeOf(sensor, cell, a, b) : -1;
    this.table.box.scrollTop = 0;
    this.table.update();
    this.pictures.mark(this.rays);
  }

  runFlip() {
    window.clearInterval(this.timer);
    const { mode, flipRuns } = this.state.choice;
    if (mode === 'flip' && flipRuns) {
      this.timer = window.setInterval(
        () => this.state.set({ flipShowsB: !this.state.choice.flipShowsB }),
        FLIP_TIME,
      );
    }
  }
}

/**
 * What the page opens on, if its model says so: a ray that is wrong, and the difference there.
 * @param {PageModel} model @param {Choice} plain @param {{key: string}[]} channels
 * @returns {Partial<Choice>}
 */
function openingChoice(model, plain, channels) {
  const asked = model.opening ? choiceOfHash(model, model.opening) : null;
  const isKnown = channels.some(({ key }) => key === asked?.channel);
  return asked ? { ...asked, channel: isKnown ? (asked.channel ?? plain.channel) : plain.channel } : {};
}

/** @param {PageModel} model @param {string[]} channels @returns {Choice} */
function plainChoice(model, channels) {
  const pair = model.sensors.flatMap((sensor) => sensor.pairs ?? [])[0];
  return {
    channel: channels.includes('range.T') ? 'range.T' : (channels[0] ?? 'range.T'),
    mode: 'a',
    a: pair?.a ?? 0,
    b: pair?.b ?? Math.min(1, Math.max(0, model.sides.length - 1)),
    sensor: 0,
    cell: -1,
    hover: null,
    ...PLAIN_DRAWING,
    showsMarks: true,
    isLinked: true,
    isCursorMode: false,
    divider: 0.5,
    opacity: 0.5,
    flipShowsB: false,
    flipRuns: false,
  };
}
