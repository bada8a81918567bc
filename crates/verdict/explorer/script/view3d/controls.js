// Mouse, fingers and keys on the canvas of a 3-D picture: turn, move and zoom its camera.

import { movedPose, turnedPose, zoomedPose } from './moves.js';

/** @typedef {import('./camera.js').EyePose} EyePose */
/** @typedef {import('./camera.js').ViewCamera} ViewCamera */
/** @typedef {import('./terrain.js').Bounds3} Bounds3 */
/**
 * @typedef {object} ControlActions
 * @property {(pose: EyePose) => void} setPose
 * @property {() => Bounds3} bounds of everything in the picture
 * @property {() => void} reset
 * @property {(x: number, y: number) => void} centre makes what is seen there the middle of turns
 */

/** CSS pixels that one press of an arrow key stands for. */
const KEY_PIXELS = 24;

/** Listens on a canvas. */
export class ViewControls {
  /** @param {HTMLElement} canvas @param {ViewCamera} camera @param {ControlActions} actions */
  constructor(canvas, camera, actions) {
    this.canvas = canvas;
    this.camera = camera;
    this.actions = actions;
    /** @type {Map<number, {x: number, y: number}>} */
    this.pointers = new Map();
    this.moves = false;
    const stop = new AbortController();
    this.stop = stop;
    const { signal } = stop;
    canvas.addEventListener('pointerdown', (event) => this.#down(event), { signal });
    canvas.addEventListener('pointermove', (event) => this.#drag(event), { signal });
    for (const name of /** @type {const} */ (['pointerup', 'pointercancel', 'lostpointercapture'])) {
      canvas.addEventListener(name, (event) => this.pointers.delete(event.pointerId), { signal });
    }
    canvas.addEventListener('contextmenu', (event) => event.preventDefault(), { signal });
    canvas.addEventListener('wheel', (event) => this.#wheel(event), { signal, passive: false });
    canvas.addEventListener('dblclick', (event) => actions.centre(event.offsetX, event.offsetY), { signal });
    canvas.addEventListener('keydown', (event) => this.#key(event), { signal });
  }

  dispose() {
    this.stop.abort();
  }

  /** By a drag of so many CSS pixels. @param {number} dx @param {number} dy */
  #turn(dx, dy) {
    this.actions.setPose(turnedPose(this.camera, dx, dy));
  }

  /** The picture, by so many CSS pixels. @param {number} dx @param {number} dy */
  #move(dx, dy) {
    this.actions.setPose(movedPose(this.camera, dx, dy));
  }

  /** Distances times a factor, about a place of the canvas. @param {number} factor @param {number} x @param {number} y */
  #zoom(factor, x, y) {
    this.actions.setPose(zoomedPose(this.camera, factor, x, y, this.actions.bounds()));
  }

  /** @param {PointerEvent} event */
  #down(event) {
    this.canvas.focus({ preventScroll: true });
    try {
      this.canvas.setPointerCapture(event.pointerId);
    } catch {
      // A pointer that is gone already cannot be captured.
    }
    this.pointers.set(event.pointerId, { x: event.offsetX, y: event.offsetY });
    this.moves = event.button !== 0 || event.shiftKey;
    event.preventDefault();
  }

  /** @param {PointerEvent} event */
  #drag(event) {
    const last = this.pointers.get(event.pointerId);
    if (!last) return;
    const now = { x: event.offsetX, y: event.offsetY };
    const [dx, dy] = [now.x - last.x, now.y - last.y];
    if (this.pointers.size === 1) {
      if (this.moves) this.#move(dx, dy);
      else this.#turn(dx, dy);
    } else if (this.pointers.size === 2) {
      const other = [...this.pointers].find(([id]) => id !== event.pointerId)?.[1] ?? now;
      const before = Math.hypot(last.x - other.x, last.y - other.y);
      const after = Math.hypot(now.x - other.x, now.y - other.y);
      // The middle of two fingers moves by half of what one finger moves.
      this.#move(dx / 2, dy / 2);
      if (before > 8 && after > 8)
        this.#zoom(before / after, (now.x + other.x) / 2, (now.y + other.y) / 2);
    }
    this.pointers.set(event.pointerId, now);
  }

  /** @param {WheelEvent} event */
  #wheel(event) {
    event.preventDefault();
    const pixels = event.deltaY * (event.deltaMode === 1 ? 18 : event.deltaMode === 2 ? 240 : 1);
    // A pinch on a touch pad comes as a wheel with Ctrl, in small steps.
    const factor = Math.exp(Math.max(-1, Math.min(1, pixels * (event.ctrlKey ? 0.01 : 0.0015))));
    this.#zoom(factor, event.offsetX, event.offsetY);
  }

  /** @param {KeyboardEvent} event */
  #key(event) {
    if (event.altKey || event.ctrlKey || event.metaKey) return;
    const arrows = /** @type {Record<string, [number, number]>} */ ({
      ArrowLeft: [KEY_PIXELS, 0],
      ArrowRight: [-KEY_PIXELS, 0],
      ArrowUp: [0, KEY_PIXELS],
      ArrowDown: [0, -KEY_PIXELS],
    });
    const [x, y] = [this.canvas.clientWidth / 2, this.canvas.clientHeight / 2];
    const arrow = arrows[event.key];
    if (arrow && event.shiftKey) this.#move(...arrow);
    else if (arrow) this.#turn(...arrow);
    else if (event.key === '+' || event.key === '=') this.#zoom(0.8, x, y);
    else if (event.key === '-' || event.key === '_') this.#zoom(1.25, x, y);
    else if (event.key === 'Home') this.actions.reset();
    else return;
    event.preventDefault();
    // The page has keys of its own.
    event.stopPropagation();
  }
}
