// Mouse, pen and fingers on a flat picture: point, choose, drag, pinch, wheel.

/**
 * @typedef {object} HandView the part of the picture that is shown, in pixels of its own
 * @property {boolean} isFitted whether everything is shown
 * @property {(factor: number, x: number, y: number) => void} zoomAbout
 * @property {(x: number, y: number) => void} panBy
 */
/**
 * @typedef {object} HandActions
 * @property {(event: {clientX: number, clientY: number}) => [number, number]} place pixels of the view
 * @property {(x: number, y: number, isHover: boolean) => void} pointed at a place; without hovering it was clicked
 * @property {() => void} left
 * @property {() => void} panned
 * @property {() => void} zoomed
 */

/** A press that moves less is a click: CSS pixels. */
const CLICK_ROOM = 4;

/** Time for which the wheel goes on scrolling the page that it began to scroll: milliseconds. */
const SCROLL_REST = 350;

export class PictureHand {
  /** @param {HTMLCanvasElement} canvas @param {HandView} view @param {HandActions} actions */
  constructor(canvas, view, actions) {
    this.canvas = canvas;
    this.view = view;
    this.actions = actions;
    /** @type {Map<number, {clientX: number, clientY: number}>} */
    this.down = new Map();
    this.moved = 0;
    this.lastScroll = -Infinity;
    canvas.addEventListener('pointerdown', (event) => this.press(event));
    canvas.addEventListener('pointermove', (event) => this.move(event));
    canvas.addEventListener('pointerup', (event) => this.release(event, true));
    canvas.addEventListener('pointercancel', (event) => this.release(event, false));
    canvas.addEventListener('pointerleave', () => actions.left());
    canvas.addEventListener('wheel', (event) => this.wheel(event), { passive: false });
    // The wheel zooms a picture only if it is not in the middle of scrolling the page.
    const scrolled = () => {
      this.lastScroll = performance.now();
    };
    window.addEventListener('scroll', scrolled, { passive: true });
  }

  /** @param {PointerEvent} event */
  press(event) {
    if (event.button !== 0) {
      return;
    }
    this.canvas.focus({ preventScroll: true });
    this.canvas.setPointerCapture(event.pointerId);
    this.down.set(event.pointerId, { clientX: event.clientX, clientY: event.clientY });
    this.moved = this.down.size > 1 ? Infinity : 0;
  }

  /** @param {PointerEvent} event */
  move(event) {
    const { view, actions } = this;
    const before = this.down.get(event.pointerId);
    const now = { clientX: event.clientX, clientY: event.clientY };
    if (!before) {
      actions.pointed(...actions.place(now), true);
      return;
    }
    const [x, y] = actions.place(now);
    const [fromX, fromY] = actions.place(before);
    const other = [...this.down.entries()].find(([id]) => id !== event.pointerId)?.[1];
    if (other) {
      const [otherX, otherY] = actions.place(other);
      const spanBefore = Math.hypot(before.clientX - other.clientX, before.clientY - other.clientY);
      const span = Math.hypot(now.clientX - other.clientX, now.clientY - other.clientY);
      view.zoomAbout(span / Math.max(1, spanBefore), (x + otherX) / 2, (y + otherY) / 2);
      view.panBy((x - fromX) / 2, (y - fromY) / 2);
      actions.zoomed();
    } else {
      this.moved += Math.abs(now.clientX - before.clientX) + Math.abs(now.clientY - before.clientY);
      if (this.moved < CLICK_ROOM) {
        return;
      }
      view.panBy(x - fromX, y - fromY);
      actions.panned();
    }
    this.down.set(event.pointerId, now);
    this.canvas.classList.add('x-dragged');
  }

  /** @param {PointerEvent} event @param {boolean} counts */
  release(event, counts) {
    const wasDown = this.down.delete(event.pointerId);
    this.canvas.classList.remove('x-dragged');
    if (wasDown && counts && this.moved < CLICK_ROOM) {
      this.actions.pointed(...this.actions.place(event), false);
    }
  }

  /** @param {WheelEvent} event */
  wheel(event) {
    const { view, actions } = this;
    const leaves = view.isFitted && event.deltaY > 0 && !event.ctrlKey;
    const isScrolling = performance.now() - this.lastScroll < SCROLL_REST && !event.ctrlKey;
    if (leaves || isScrolling) {
      return;
    }
    event.preventDefault();
    const lines = event.deltaMode === 1 ? 16 : event.deltaMode === 2 ? 400 : 1;
    const speed = event.ctrlKey ? 0.01 : 0.0022;
    const factor = Math.exp(-Math.max(-300, Math.min(300, event.deltaY * lines)) * speed);
    view.zoomAbout(factor, ...actions.place(event));
    actions.zoomed();
  }
}
