// The line between both sides of a picture, moved by pointer and keys.

import { element } from '../elements.js';

/** Way of the line by each key, as a share of the picture. @type {Record<string, number>} */
const DIVIDER_STEPS = { ArrowLeft: -0.02, ArrowRight: 0.02, PageDown: -0.1, PageUp: 0.1, Home: -1, End: 1 };

/**
 * @param {string} name of the sensor
 * @param {import('../state.js').State} state
 * @param {(event: PointerEvent) => number} shareAt place of the pointer, 0 to 1 in the picture
 */
export function pictureDivider(name, state, shareAt) {
  const divider = element('div', {
    class: 'x-divider',
    role: 'slider',
    tabindex: '0',
    'aria-label': `${name}: line between A and B`,
    'aria-valuemin': '0',
    'aria-valuemax': '100',
    hidden: true,
  });
  const set = (/** @type {number} */ place) => state.set({ divider: Math.min(1, Math.max(0, place)) });
  divider.addEventListener('pointerdown', (event) => {
    divider.setPointerCapture(event.pointerId);
    event.preventDefault();
    divider.focus({ preventScroll: true });
  });
  divider.addEventListener('pointermove', (event) => {
    if (divider.hasPointerCapture(event.pointerId)) {
      set(shareAt(event));
    }
  });
  divider.addEventListener('keydown', (event) => {
    const step = DIVIDER_STEPS[event.key];
    if (step !== undefined) {
      set(state.choice.divider + step);
      event.preventDefault();
      event.stopPropagation();
    }
  });
  return divider;
}
