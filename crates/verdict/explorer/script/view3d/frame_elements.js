// The elements of every 3-D picture: its frame with the canvas and a message, and what its mouse does.

import { element } from '../elements.js';

export const TURN_HELP = 'Drag: turn. Shift or right button, or two fingers: move.';

/** @param {string} label of the canvas, for people who do not see it @param {string} waiting what is said before there is a picture */
export function pictureFrame(label, waiting) {
  const canvas = element('canvas', {
    class: 'view3d-canvas',
    tabindex: '0',
    role: 'img',
    'aria-keyshortcuts': 'ArrowLeft ArrowRight ArrowUp ArrowDown + - Home',
    'aria-label': label,
  });
  const message = element('p', { class: 'view3d-message', role: 'status' }, waiting);
  return { canvas, message, stage: element('div', { class: 'view3d-stage' }, canvas, message) };
}
