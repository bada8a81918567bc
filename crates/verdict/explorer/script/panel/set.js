// The pictures of all sensors: what pointer and keys do to them, and how they keep step.

import { SensorPanel } from './panel.js';

/** @typedef {import('../data/page_model.js').PageModel} PageModel */
/** @typedef {import('../state.js').State} State */
/** @typedef {import('./painter.js').Painter} Painter */
/** @typedef {import('../rays/list.js').RayList} RayList */

/** Rest before pictures out of sight are painted too: milliseconds. */
const EARLY_PAINT_REST = 1200;

/** Of more sensors, only the pictures in sight are painted. */
const MOST_EARLY_PANELS = 6;

export class PanelSet {
  /** @param {PageModel} model @param {State} state @param {Painter} painter @param {() => void} painted */
  constructor(model, state, painter, painted) {
    this.model = model;
    this.state = state;
    this.panels = [...model.sensors.keys()].map(
      (index) =>
        new SensorPanel(index, state, painter, {
          viewChanged: (panel) => this.follow(panel),
          pointed: (sensor, cell, isHover) => this.point(sensor, cell, isHover),
          left: () => state.set({ hover: null }),
          painted,
        }),
    );
  }

  /** The panel of the selected cell. */
  get chosen() {
    return this.panels[this.state.choice.sensor];
  }

  /** The panel that keys act on: that with the focus, else that of the selected cell. */
  get active() {
    return this.panels.find((panel) => panel.canvas === document.activeElement) ?? this.chosen;
  }

  /** Paints, after a rest, also the pictures that nobody has seen yet: the page may be printed. */
  paintLater() {
    if (this.panels.length <= MOST_EARLY_PANELS) {
      window.setTimeout(() => this.panels.forEach((panel) => panel.wake()), EARLY_PAINT_REST);
    }
  }

  /** @param {number} sensor @param {number} cell @param {boolean} isHover */
  point(sensor, cell, isHover) {
    if (isHover) {
      const { hover } = this.state.choice;
      if (cell < 0) {
        this.state.set({ hover: null });
      } else if (hover?.sensor !== sensor || hover.cell !== cell) {
        this.state.set({ hover: { sensor, cell } });
      }
    } else {
      this.state.set({ sensor, cell });
    }
  }

  /** Moves the cursor. @param {number} across @param {number} down */
  moveCursor(across, down) {
    const panel = this.active;
    const { view, sensorIndex: sensor } = panel;
    const { width, height } = panel.sensor;
    const cell = sensor === this.state.choice.sensor ? this.state.choice.cell : -1;
    const from = cell >= 0 ? cell : Math.floor(view.centreY) * width + Math.floor(view.centreX);
    const i = Math.min(width - 1, Math.max(0, (from % width) + (cell >= 0 ? across : 0)));
    const j = Math.min(height - 1, Math.max(0, Math.floor(from / width) + (cell >= 0 ? down : 0)));
    this.state.set({ sensor, cell: j * width + i, hover: null });
    if (!view.shows(j * width + i)) {
      view.centreOn(j * width + i, 0);
      this.follow(panel);
      panel.draw();
    }
  }

  /** @param {number} across @param {number} down shares of the picture */
  pan(across, down) {
    const panel = this.active;
    panel.view.panBy(-across * panel.view.width, -down * panel.view.height);
    this.follow(panel);
    panel.draw();
  }

  /** @param {number} factor */
  zoom(factor) {
    const panel = this.active;
    const { view } = panel;
    const { cell } = this.state.choice;
    const isSeen = panel === this.chosen && cell >= 0 && view.shows(cell);
    const x = isSeen ? view.left + ((cell % view.columns) + 0.5) * view.scaleX : view.width / 2;
    const y = isSeen ? view.top + (Math.floor(cell / view.columns) + 0.5) * view.scaleY : view.height / 2;
    view.zoomAbout(factor, x, y);
    this.follow(panel);
    panel.draw();
  }

  fit() {
    this.panels.forEach((panel) => {
      panel.view.fit();
      panel.draw();
    });
  }

  /** Panels of sensors of the same size show the same part. @param {SensorPanel} panel */
  follow(panel) {
    if (!this.state.choice.isLinked) {
      return;
    }
    const { width, height } = panel.sensor;
    for (const other of this.panels) {
      if (other !== panel && other.sensor.width === width && other.sensor.height === height) {
        other.view.follow(panel.view);
        other.draw();
      }
    }
  }

  /** Brings the selected cell into view. */
  showSelected() {
    const { cell } = this.state.choice;
    const panel = this.chosen;
    if (cell >= 0) {
      panel.goTo(cell);
    }
    // Keys go on with the picture that was gone to.
    if (this.active !== panel) {
      panel.canvas.focus({ preventScroll: true });
    }
    panel.root.scrollIntoView({ block: 'nearest' });
  }

  /** Marks the rays that the table shows. @param {RayList} rays */
  mark(rays) {
    const { a, b } = this.state.choice;
    for (const panel of this.panels) {
      panel.marked = rays.marksOn(panel.sensorIndex, a, b);
      panel.draw();
    }
  }
}
