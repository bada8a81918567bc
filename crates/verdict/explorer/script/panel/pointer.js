// Mouse, pen and fingers on a picture: point, select, drag, pinch, wheel, and the divider of the slider.

/** @typedef {import('./panel.js').SensorPanel} SensorPanel */

/** A press that moves less is a click: CSS pixels. */
const CLICK_ROOM = 4;

/** Time for which the wheel goes on scrolling the page that it began to scroll: milliseconds. */
const SCROLL_REST = 350;

let lastScroll = -Infinity;

export class PointerHand {
  /** @param {SensorPanel} panel */
  constructor(panel) {
    this.panel = panel;
    /** @type {Map<number, {x: number, y: number}>} */
    this.down = new Map();
    this.moved = 0;
    const { canvas, divider } = panel;
    canvas.addEventListener('pointerdown', (event) => this.press(event));
    canvas.addEventListener('pointermove', (event) => this.move(event));
    canvas.addEventListener('pointerup', (event) => this.release(event, true));
    canvas.addEventListener('pointercancel', (event) => this.release(event, false));
    canvas.addEventListener('pointerleave', () => panel.host.left());
    canvas.addEventListener('wheel', (event) => this.wheel(event), { passive: false });
    divider.addEventListener('pointerdown', (event) => {
      divider.setPointerCapture(event.pointerId);
      event.preventDefault();
      divider.focus({ preventScroll: true });
    });
    divider.addEventListener('pointermove', (event) => {
      if (divider.hasPointerCapture(event.pointerId)) {
        this.setDivider(this.place(event)[0] / panel.view.width);
      }
    });
    divider.addEventListener('keydown', (event) => this.dividerKey(event));
    watchScrolling();
  }

  /**
   * Pixels of the device within the area.
   * @param {{clientX: number, clientY: number}} event
   * @returns {[number, number]}
   */
  place(event) {
    const box = this.panel.canvas.getBoundingClientRect();
    const { area, view } = this.panel;
    return [
      (event.clientX - box.left) * view.ratio - area.x,
      (event.clientY - box.top) * view.ratio - area.y,
    ];
  }

  /** @param {PointerEvent} event */
  cellUnder(event) {
    const [x, y] = this.place(event);
    const { view } = this.panel;
    return x < 0 || y < 0 || x >= view.width || y >= view.height ? -1 : view.cellAt(x, y);
  }

  /** @param {PointerEvent} event */
  press(event) {
    if (event.button !== 0) {
      return;
    }
    this.panel.canvas.focus({ preventScroll: true });
    this.panel.canvas.setPointerCapture(event.pointerId);
    this.down.set(event.pointerId, { x: event.clientX, y: event.clientY });
    this.moved = this.down.size > 1 ? Infinity : 0;
  }

  /** @param {PointerEvent} event */
  move(event) {
    const before = this.down.get(event.pointerId);
    if (!before) {
      this.panel.host.pointed(this.panel.sensorIndex, this.cellUnder(event), true);
      return;
    }
    const { view } = this.panel;
    const [dx, dy] = [event.clientX - before.x, event.clientY - before.y];
    const others = [...this.down.entries()]
      .filter(([id]) => id !== event.pointerId)
      .map(([, place]) => place);
    if (others.length > 0) {
      const other = others[0];
      const spanBefore = Math.hypot(before.x - other.x, before.y - other.y);
      const span = Math.hypot(event.clientX - other.x, event.clientY - other.y);
      const middle = this.place({
        clientX: (event.clientX + other.x) / 2,
        clientY: (event.clientY + other.y) / 2,
      });
      view.zoomAbout(span / Math.max(1, spanBefore), middle[0], middle[1]);
      view.panBy((dx / 2) * view.ratio, (dy / 2) * view.ratio);
    } else {
      this.moved += Math.abs(dx) + Math.abs(dy);
      if (this.moved < CLICK_ROOM) {
        return;
      }
      view.panBy(dx * view.ratio, dy * view.ratio);
    }
    this.down.set(event.pointerId, { x: event.clientX, y: event.clientY });
    this.panel.canvas.classList.add('x-dragged');
    this.changed();
  }

  /** @param {PointerEvent} event @param {boolean} counts */
  release(event, counts) {
    const wasDown = this.down.delete(event.pointerId);
    this.panel.canvas.classList.remove('x-dragged');
    if (wasDown && counts && this.moved < CLICK_ROOM) {
      const cell = this.cellUnder(event);
      if (cell >= 0) {
        this.panel.host.pointed(this.panel.sensorIndex, cell, false);
      }
    }
  }

  /** @param {WheelEvent} event */
  wheel(event) {
    const { view } = this.panel;
    const leaves = view.isFitted && event.deltaY > 0 && !event.ctrlKey;
    const isScrolling = performance.now() - lastScroll < SCROLL_REST && !event.ctrlKey;
    if (leaves || isScrolling) {
      return;
    }
    event.preventDefault();
    const lines = event.deltaMode === 1 ? 16 : event.deltaMode === 2 ? 400 : 1;
    const speed = event.ctrlKey ? 0.01 : 0.0022;
    const factor = Math.exp(-Math.max(-300, Math.min(300, event.deltaY * lines)) * speed);
    const [x, y] = this.place(event);
    view.zoomAbout(factor, x, y);
    this.changed();
  }

  changed() {
    this.panel.host.viewChanged(this.panel);
    this.panel.draw();
  }

  /** @param {number} place 0 to 1 */
  setDivider(place) {
    this.panel.state.set({ divider: Math.min(1, Math.max(0, place)) });
  }

  /** @param {KeyboardEvent} event */
  dividerKey(event) {
    const step = { ArrowLeft: -0.02, ArrowRight: 0.02, PageDown: -0.1, PageUp: 0.1, Home: -1, End: 1 }[
      event.key
    ];
    if (step !== undefined) {
      this.setDivider(this.panel.state.choice.divider + step);
      event.preventDefault();
      event.stopPropagation();
    }
  }
}

let isWatching = false;

/** The wheel zooms a picture only if it is not in the middle of scrolling the page. */
function watchScrolling() {
  if (!isWatching) {
    isWatching = true;
    window.addEventListener(
      'scroll',
      () => {
        lastScroll = performance.now();
      },
      { passive: true },
    );
  }
}
