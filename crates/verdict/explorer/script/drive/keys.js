// Keys of the drive panel, and the dialog that lists them.

import { helpDialog } from '../keyboard.js';

/** @typedef {import('./panel.js').DrivePanel} DrivePanel */
/** @typedef {import('./scale.js').MapColouring} MapColouring */
/** @typedef {import('./map.js').DriveMap} DriveMap */
/** @typedef {{keys: string[], words: string, run: () => void}} DriveKey */

/** @param {DrivePanel} panel @returns {DriveKey[]} */
function keyList(panel) {
  const { state, timeline, table } = panel;
  if (!timeline || !table) { return []; }
  const count = timeline.record.count;
  const colour = (/** @type {MapColouring} */ colouring) => state.set({ colouring });
  const clear = () => state.set({ sector: -1, cell: null });
  const follow = () => state.set({ mapFollows: !state.choice.mapFollows });
  return [
    { keys: [' '], words: 'play or pause', run: () => timeline.toggle() },
    { keys: ['ArrowLeft', ','], words: 'previous frame', run: () => timeline.step(-1) },
    { keys: ['ArrowRight', '.'], words: 'next frame', run: () => timeline.step(1) },
    { keys: ['PageUp'], words: 'previous obstacle map', run: () => timeline.stepMap(-1) },
    { keys: ['PageDown'], words: 'next obstacle map', run: () => timeline.stepMap(1) },
    { keys: ['Home'], words: 'first frame', run: () => timeline.step(-count) },
    { keys: ['End'], words: 'last frame', run: () => timeline.step(count) },
    { keys: ['n'], words: 'next sector, to the left', run: () => table.step(1) },
    { keys: ['p'], words: 'previous sector, to the right', run: () => table.step(-1) },
    { keys: ['1'], words: 'colours by elevation', run: () => colour('elevation') },
    { keys: ['2'], words: 'colours by source', run: () => colour('source') },
    { keys: ['3'], words: 'colours by error against the true ground', run: () => colour('error') },
    { keys: ['f'], words: 'the map follows the vehicle', run: follow },
    { keys: ['0'], words: 'show the whole map', run: () => panel.fit() },
    { keys: ['Escape'], words: 'nothing is chosen', run: clear },
  ];
}

/** Keys that only pictures have. */
const PICTURE_KEYS = [
  { keys: ['arrows'], words: 'on the map: move the picture; with Shift the cell cursor' },
  { keys: ['+', '−'], words: 'on the map and in 3-D: zoom' },
  { keys: ['arrows'], words: 'in 3-D: turn; with Shift move' },
];

const DRIVE_HELP = 'On the map: wheel or two fingers zoom, drag moves, a click chooses a cell and a sector. Keys work '
  + 'while a part of the drive has the focus.';

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
  const dialog = helpDialog('The drive: mouse and keys', DRIVE_HELP, [...list, ...PICTURE_KEYS]);
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
      found.run();
    }
  });
  return { dialog, list };
}

/** Cells to the right and upward of each arrow key. @type {Record<string, [number, number]>} */
const ARROW_STEPS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

/** Listens on the map: arrows, zoom, and the double click. @param {DriveMap} map */
export function mapKeys(map) {
  const { canvas, view, state } = map;
  canvas.addEventListener('dblclick', (event) => {
    view.zoomAbout(event.shiftKey ? 0.5 : 2, ...map.place(event));
    map.ask();
  });
  canvas.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) { return; }
    const arrow = ARROW_STEPS[event.key];
    if (arrow && event.shiftKey) {
      map.moveCell(...arrow);
    } else if (arrow) {
      view.panBy(-arrow[0] * 60, arrow[1] * 60);
      state.set({ mapFollows: false });
    } else if (event.key === '+' || event.key === '=') {
      view.zoomAbout(1.4, view.width / 2, view.height / 2);
    } else if (event.key === '-' || event.key === '−') {
      view.zoomAbout(1 / 1.4, view.width / 2, view.height / 2);
    } else if (event.key === '0') {
      view.fit();
      state.set({ mapFollows: false });
    } else {
      return;
    }
    event.preventDefault();
    event.stopPropagation();
    map.ask();
  });
}
