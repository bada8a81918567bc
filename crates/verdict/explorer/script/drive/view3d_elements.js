// The elements of the drive's 3-D picture: buttons of views, switches, canvas, labels. They look as those of the
// 3-D panel.

import { button, element, menu } from '../elements.js';
import { lengthInWords } from '../view3d/words.js';

/** @typedef {'ground'|'cells'|'sheets'|'frustum'|'sectors'|'grid'} DriveShow */
/** @typedef {'vehicle'|'overview'|'top'|'camera'} DriveViewName */
/**
 * @typedef {object} View3dActions
 * @property {(name: DriveViewName) => void} view
 * @property {(isOn: boolean) => void} follow
 * @property {(lift: number) => void} lift metres
 * @property {(name: DriveShow, isShown: boolean) => void} show
 */

/** What can be shown or hidden, with its words. @type {[DriveShow, string][]} */
export const DRIVE_SHOWS = [
  ['ground', 'true ground'], ['cells', 'map'], ['sheets', 'sheets of light'], ['frustum', 'camera'],
  ['sectors', 'sectors'], ['grid', 'grid'],
];

/** @type {[DriveViewName, string][]} */
const DRIVE_VIEWS = [
  ['vehicle', 'vehicle'], ['overview', 'overview'], ['top', 'top'], ['camera', 'from the camera'],
];

/** Heights of the map over its elevations, metres. */
const CELL_LIFTS = [0, 0.02, 0.1, 0.5];

const VIEW3D_HELP = 'Drag: turn. Shift or right button, or two fingers: move. Wheel: zoom. Double click: turn about '
  + 'that place. The map has the colours of the map above. The vehicle stands where it truly is, and its sheets of '
  + 'light end on the true ground.';

/** @param {boolean} follows @param {number} lift metres @param {View3dActions} actions */
export function view3dElements(follows, lift, actions) {
  const switches = DRIVE_SHOWS.map(([name, words]) => {
    const box = element('input', { type: 'checkbox', checked: true, 'data-drive-show': name });
    box.addEventListener('change', () => actions.show(name, box.checked));
    return element('label', {}, box, ` ${words}`);
  });
  const follow = element('input', { type: 'checkbox', checked: follows, 'data-drive-follow': true });
  follow.addEventListener('change', () => actions.follow(follow.checked));
  const views = DRIVE_VIEWS.map(
    ([name, words]) => button(words, () => actions.view(name), { 'data-drive-view': name }));
  /** @type {[string, string][]} */
  const heights = CELL_LIFTS.map((height) => (
    [String(height), height === 0 ? 'map at its height' : `map ${lengthInWords(height)} up`]));
  const lifts = menu('height of the map over its elevations', heights, String(lift),
    (value) => actions.lift(Number(value)));
  const canvas = element('canvas', {
    class: 'view3d-canvas', tabindex: '0', role: 'img',
    'aria-keyshortcuts': 'ArrowLeft ArrowRight ArrowUp ArrowDown + - Home',
    'aria-label': 'The drive in three dimensions. Arrow keys turn, with Shift they move, + and − zoom, '
      + 'Home goes back to the vehicle.',
  });
  const overlay = element('canvas', { class: 'view3d-overlay', 'aria-hidden': 'true' });
  const labels = element('div', { class: 'view3d-labels', 'aria-hidden': 'true' });
  const message = element('p', { class: 'view3d-message', role: 'status' }, 'The ground is being read.');
  const stage = element('div', { class: 'view3d-stage' }, canvas, overlay, labels, message);
  const root = element('div', { class: 'view3d drive-3d', 'data-drive-3d': true, 'data-state': 'waiting' },
    element('div', { class: 'view3d-bar', role: 'toolbar', 'aria-label': 'Views' }, ...views,
      element('label', {}, follow, ' follow the vehicle'), lifts),
    element('div', { class: 'view3d-bar', role: 'group', 'aria-label': 'What is shown' }, ...switches), stage,
    element('p', { class: 'view3d-help soft' }, VIEW3D_HELP));
  return { root, stage, canvas, overlay, labels, message, follow };
}
