// The keys of the explorer.

/** @typedef {import('./explorer.js').Explorer} Explorer */
/** @typedef {import('./keyboard.js').KeyEntry} KeyEntry */

/** Share of the picture that an arrow key moves it by. */
const PAN_STEP = 0.12;

/** @type {Record<string, [number, number]>} */
const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

export const EXPLORER_HELP =
  'Wheel or two fingers: zoom about the pointer. Drag: move. Click: select a cell. Keys ' +
  'work while a picture or another part of this section has the focus.';

/** @param {Explorer} explorer @returns {KeyEntry[]} */
export function explorerKeys(explorer) {
  const { state } = explorer;
  /** @param {string[]} keys @param {string} words @param {(event: KeyboardEvent) => void} run */
  const key = (keys, words, run) => ({ keys, words, run });
  return [
    key(Object.keys(ARROWS), 'move the picture; with Shift, or in cursor mode, the cursor', (event) => {
      const [across, down] = ARROWS[event.key];
      if (event.shiftKey !== state.choice.isCursorMode) {
        explorer.pictures.moveCursor(across, down);
      } else {
        explorer.pictures.pan(across * PAN_STEP, down * PAN_STEP);
      }
    }),
    key(['c'], 'cursor mode: arrow keys move the cursor without Shift', () =>
      state.set({ isCursorMode: !state.choice.isCursorMode }),
    ),
    key(['+', '='], 'larger', () => explorer.pictures.zoom(1.5)),
    key(['-', '_'], 'smaller', () => explorer.pictures.zoom(1 / 1.5)),
    key(['0'], 'show everything', () => explorer.pictures.fit()),
    key(['1'], 'side A', () => explorer.toolbar.chooseMode('a')),
    key(['2'], 'side B', () => explorer.toolbar.chooseMode('b')),
    key(['3'], 'difference B − A', () => explorer.toolbar.chooseMode('difference')),
    key(['4'], 'slider between A and B', () => explorer.toolbar.chooseMode('slider')),
    key(['5'], 'blend of A and B', () => explorer.toolbar.chooseMode('blend')),
    key(['f'], 'flip: the other side', () => {
      const { mode, flipShowsB } = state.choice;
      const showsB = mode === 'b' || (mode === 'flip' && flipShowsB);
      state.set({ mode: 'flip', flipRuns: false, flipShowsB: !showsB });
    }),
    key(['e', 'E'], 'exposure: e brighter, E darker', (event) =>
      explorer.toolbar.expose(event.key === 'e' ? 0.5 : -0.5),
    ),
    key(['l'], 'logarithmic scale', () => explorer.toolbar.toggleLog()),
    key(['r'], 'reset exposure, limits and view', () => {
      explorer.toolbar.reset();
      explorer.pictures.fit();
    }),
    key(['m'], 'marks on rays that do not agree', () => state.set({ showsMarks: !state.choice.showsMarks })),
    key(['[', ']'], 'previous, next quantity', (event) => explorer.stepChannel(event.key === ']' ? 1 : -1)),
    key(['s', 'S'], 'next, previous sensor', (event) => explorer.stepSensor(event.key === 's' ? 1 : -1)),
    key(['n', 'p'], 'next, previous ray of the table', (event) => explorer.step(event.key === 'n' ? 1 : -1)),
    key(['t'], 'to the table: arrow keys choose a row, Enter shows it', () => explorer.table.box.focus()),
    key(['?'], 'this list', () => explorer.help.showModal()),
    key(['Escape'], 'select nothing', () => {
      state.set({ cell: -1, hover: null });
      history.replaceState(null, '', window.location.pathname + window.location.search);
    }),
  ];
}
