// The elements of the drive's 3-D picture: buttons of views, switches, canvas, labels. They look as those of the
// 3-D panel.

import { button, checkbox, element, menu } from '../elements.js';
import { TURN_HELP, pictureFrame } from '../view3d/frame_elements.js';
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

const VIEW3D_HELP = `${TURN_HELP} Wheel: zoom. Double click: turn about that place. `
  + 'The map has the colours of the map above. The vehicle stands where it truly is, and its sheets of '
  + 'light end on the true ground.';

/** @param {boolean} follows @param {number} lift metres @param {View3dActions} actions */
export function view3dElements(follows, lift, actions) {
  const switches = DRIVE_SHOWS.map(([name, words]) => (
    checkbox(words, true, (isShown) => actions.show(name, isShown), { 'data-drive-show': name }).label));
  const follow = checkbox('follow the vehicle', follows, actions.follow, { 'data-drive-follow': true });
  const views = DRIVE_VIEWS.map(
    ([name, words]) => button(words, () => actions.view(name), { 'data-drive-view': name }));
  /** @type {[string, string][]} */
  const heights = CELL_LIFTS.map((height) => (
    [String(height), height === 0 ? 'map at its height' : `map ${lengthInWords(height)} up`]));
  const lifts = menu('height of the map over its elevations', heights, String(lift),
    (value) => actions.lift(Number(value)));
  const frame = pictureFrame('The drive in three dimensions. Arrow keys turn, with Shift they move, + and − zoom, '
    + 'Home goes back to the vehicle.', 'The ground is being read.');
  const root = element('div', { class: 'view3d drive-3d', 'data-drive-3d': true, 'data-state': 'waiting' },
    element('div', { class: 'view3d-bar', role: 'toolbar', 'aria-label': 'Views' }, ...views,
      follow.label, lifts),
    element('div', { class: 'view3d-bar', role: 'group', 'aria-label': 'What is shown' }, ...switches), frame.stage,
    element('p', { class: 'view3d-help soft' }, VIEW3D_HELP));
  return { root, ...frame, follow: follow.input };
}
