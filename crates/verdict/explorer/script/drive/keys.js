// Keys of the drive panel, and the dialog that lists them.

import { button, element } from '../elements.js';

/** @typedef {import('./panel.js').DrivePanel} DrivePanel */
/** @typedef {import('./scale.js').MapColouring} MapColouring */
/** @typedef {{keys: string[], words: string, label: string, action: () => void}} DriveKey */

/** @param {DrivePanel} panel @returns {DriveKey[]} */
function keyList(panel) {
  const { state, timeline, table } = panel;
  if (!timeline || !table) { return []; }
  const count = timeline.record.count;
  const colour = (/** @type {MapColouring} */ colouring) => state.set({ colouring });
  const clear = () => state.set({ sector: -1, cell: null });
  const follow = () => state.set({ mapFollows: !state.choice.mapFollows });
  return [
    { keys: [' '], label: 'Space', words: 'play or pause', action: () => timeline.toggle() },
    { keys: ['ArrowLeft', ','], label: '← or ,', words: 'previous frame', action: () => timeline.step(-1) },
    { keys: ['ArrowRight', '.'], label: '→ or .', words: 'next frame', action: () => timeline.step(1) },
    { keys: ['PageUp'], label: 'Page up', words: 'previous obstacle map', action: () => timeline.stepMap(-1) },
    { keys: ['PageDown'], label: 'Page down', words: 'next obstacle map', action: () => timeline.stepMap(1) },
    { keys: ['Home'], label: 'Home', words: 'first frame', action: () => timeline.step(-count) },
    { keys: ['End'], label: 'End', words: 'last frame', action: () => timeline.step(count) },
    { keys: ['n'], label: 'n', words: 'next sector, to the left', action: () => table.step(1) },
    { keys: ['p'], label: 'p', words: 'previous sector, to the right', action: () => table.step(-1) },
    { keys: ['1'], label: '1', words: 'colours by elevation', action: () => colour('elevation') },
    { keys: ['2'], label: '2', words: 'colours by source', action: () => colour('source') },
    { keys: ['3'], label: '3', words: 'colours by error against the true ground', action: () => colour('error') },
    { keys: ['f'], label: 'f', words: 'the map follows the vehicle', action: follow },
    { keys: ['0'], label: '0', words: 'show the whole map', action: () => panel.fit() },
    { keys: ['Escape'], label: 'Esc', words: 'nothing is chosen', action: clear },
  ];
}

/** Keys that only pictures have. @type {[string, string][]} */
const PICTURE_KEYS = [
  ['arrows', 'on the map: move the picture; with Shift the cell cursor'],
  ['+ and −', 'on the map and in 3-D: zoom'],
  ['arrows', 'in 3-D: turn; with Shift move'],
];

/** Whether an element has a use of its own for a key. @param {HTMLElement} target @param {string} key */
function isOwnKey(target, key) {
  if (target.matches('button, input[type="checkbox"]')) {
    return key === ' ' || key === 'Enter';
  }
  const isNamed = key.length > 1 && key !== 'Escape';
  return (target.matches('select') && (isNamed || key === ' '))
    || (target.matches('.drive-scroll') && isNamed && key !== 'ArrowLeft' && key !== 'ArrowRight');
}

/** Listens on the panel, and makes the dialog. @param {DrivePanel} panel */
export function driveKeys(panel) {
  const list = keyList(panel);
  const rows = [...list.map(({ label, words }) => [label, words]), ...PICTURE_KEYS]
    .map(([label, words]) => element('tr', {},
      element('th', { scope: 'row' }, element('kbd', {}, label)), element('td', {}, words)));
  const dialog = element('dialog', { class: 'drive-help', 'aria-label': 'Keys' }, element('h3', {}, 'Keys'),
    element('table', {}, element('tbody', {}, ...rows)),
    button('close', () => dialog.close(), { autofocus: true }));
  panel.root.addEventListener('keydown', (event) => {
    const target = /** @type {HTMLElement} */ (event.target);
    if (event.ctrlKey || event.metaKey || event.altKey || dialog.open || event.defaultPrevented) { return; }
    if (isOwnKey(target, event.key)) { return; }
    if (event.key === '?') {
      dialog.showModal();
      event.preventDefault();
      return;
    }
    const found = event.shiftKey ? null : list.find(({ keys }) => keys.includes(event.key));
    if (found) {
      event.preventDefault();
      found.action();
    }
  });
  return { dialog, list };
}
