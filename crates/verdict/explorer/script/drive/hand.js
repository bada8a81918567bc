// Mouse, pen, fingers, wheel and keys on the map from above.

/** @typedef {import('./map.js').DriveMap} DriveMap */

/** A press that moves less is a click: CSS pixels. */
const HAND_ROOM = 4;

/** Cells to the right and upward of each arrow key. @type {Record<string, [number, number]>} */
const ARROW_STEPS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

/** Time for which the wheel goes on scrolling the page that it began to scroll: milliseconds. */
const HAND_REST = 350;

export class DriveHand {
  /** @param {DriveMap} map */
  constructor(map) {
    this.map = map;
    /** @type {Map<number, {x: number, y: number}>} */
    this.down = new Map();
    this.moved = 0;
    this.lastScroll = -Infinity;
    const { canvas } = map;
    canvas.addEventListener('pointerdown', (event) => this.press(event));
    canvas.addEventListener('pointermove', (event) => this.move(event));
    canvas.addEventListener('pointerup', (event) => this.release(event, true));
    canvas.addEventListener('pointercancel', (event) => this.release(event, false));
    canvas.addEventListener('pointerleave', () => map.left());
    canvas.addEventListener('wheel', (event) => this.wheel(event), { passive: false });
    canvas.addEventListener('keydown', (event) => this.key(event));
    canvas.addEventListener('dblclick', (event) => {
      map.view.zoomAbout(event.shiftKey ? 0.5 : 2, ...this.place(event));
      map.ask();
    });
    window.addEventListener('scroll', () => { this.lastScroll = performance.now(); }, { passive: true });
  }

  /** @param {{clientX: number, clientY: number}} event @returns {[number, number]} */
  place(event) {
    const box = this.map.canvas.getBoundingClientRect();
    const { clientLeft, clientTop } = this.map.canvas;
    return [event.clientX - box.left - clientLeft, event.clientY - box.top - clientTop];
  }

  /** @param {PointerEvent} event */
  press(event) {
    if (event.button !== 0) { return; }
    this.map.canvas.focus({ preventScroll: true });
    this.map.canvas.setPointerCapture(event.pointerId);
    this.down.set(event.pointerId, { x: event.clientX, y: event.clientY });
    this.moved = this.down.size > 1 ? Infinity : 0;
  }

  /** @param {PointerEvent} event */
  move(event) {
    const { map } = this;
    const before = this.down.get(event.pointerId);
    if (!before) {
      if (event.pointerType !== 'touch') { map.pointed(...this.place(event), false); }
      return;
    }
    const [dx, dy] = [event.clientX - before.x, event.clientY - before.y];
    const other = [...this.down.entries()].find(([id]) => id !== event.pointerId)?.[1];
    if (other) {
      const spanBefore = Math.hypot(before.x - other.x, before.y - other.y);
      const span = Math.hypot(event.clientX - other.x, event.clientY - other.y);
      const middle = this.place({ clientX: (event.clientX + other.x) / 2, clientY: (event.clientY + other.y) / 2 });
      map.view.zoomAbout(span / Math.max(1, spanBefore), ...middle);
      map.view.panBy(dx / 2, dy / 2);
    } else {
      this.moved += Math.abs(dx) + Math.abs(dy);
      if (this.moved < HAND_ROOM) { return; }
      map.view.panBy(dx, dy);
      map.state.set({ mapFollows: false });
    }
    this.down.set(event.pointerId, { x: event.clientX, y: event.clientY });
    map.canvas.classList.add('drive-dragged');
    map.ask();
  }

  /** @param {PointerEvent} event @param {boolean} counts */
  release(event, counts) {
    const wasDown = this.down.delete(event.pointerId);
    this.map.canvas.classList.remove('drive-dragged');
    if (wasDown && counts && this.moved < HAND_ROOM) {
      this.map.pointed(...this.place(event), true);
    }
  }

  /** @param {WheelEvent} event */
  wheel(event) {
    const { view } = this.map;
    const leaves = view.isFitted && event.deltaY > 0 && !event.ctrlKey;
    const isScrolling = performance.now() - this.lastScroll < HAND_REST && !event.ctrlKey;
    if (leaves || isScrolling) { return; }
    event.preventDefault();
    const lines = event.deltaMode === 1 ? 16 : event.deltaMode === 2 ? 400 : 1;
    const speed = event.ctrlKey ? 0.01 : 0.0022;
    const factor = Math.exp(-Math.max(-300, Math.min(300, event.deltaY * lines)) * speed);
    view.zoomAbout(factor, ...this.place(event));
    this.map.follow();
    this.map.ask();
  }

  /** @param {KeyboardEvent} event */
  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) { return; }
    const { map } = this;
    const { view } = map;
    const [di, dj] = ARROW_STEPS[event.key] ?? [0, 0];
    if (di !== 0 || dj !== 0) {
      if (event.shiftKey) {
        map.moveCell(di, dj);
      } else {
        view.panBy(-di * 60, dj * 60);
        map.state.set({ mapFollows: false });
      }
    } else if (event.key === '+' || event.key === '=') {
      view.zoomAbout(1.4, view.width / 2, view.height / 2);
    } else if (event.key === '-' || event.key === '−') {
      view.zoomAbout(1 / 1.4, view.width / 2, view.height / 2);
    } else if (event.key === '0') {
      view.fit();
      map.state.set({ mapFollows: false });
    } else {
      return;
    }
    event.preventDefault();
    event.stopPropagation();
    map.ask();
  }
}
