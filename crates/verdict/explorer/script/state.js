// What the reader has chosen, and who wants to know when it changes.

/** @typedef {'a'|'b'|'difference'|'flip'|'slider'|'blend'} PictureMode */
/**
 * @typedef {object} Choice
 * @property {string} channel key of the quantity
 * @property {PictureMode} mode
 * @property {number} a index of a side
 * @property {number} b index of a side
 * @property {number} sensor the sensor that keys act on
 * @property {number} cell the selected cell of that sensor; -1 for none
 * @property {{sensor: number, cell: number}|null} hover the cell under the pointer
 * @property {number} exposure stops of a factor 2
 * @property {boolean} isRobust
 * @property {boolean|null} isLogOfValues null: as the values suggest
 * @property {boolean|null} isLogOfDifferences null: as the differences suggest
 * @property {boolean} showsMarks
 * @property {boolean} isLinked
 * @property {boolean} isCursorMode arrow keys move the cursor
 * @property {number} divider place of the slider's divider, 0 to 1
 * @property {number} opacity of b in a blend
 * @property {boolean} flipShowsB
 * @property {boolean} flipRuns
 */

export const PICTURE_MODES = /** @type {const} */ ([
  ['a', 'A', 'The picture of side A.'],
  ['b', 'B', 'The picture of side B.'],
  ['difference', 'B − A', 'The difference of both sides.'],
  ['slider', 'Slider', 'A to the left of a line, B to the right.'],
  ['blend', 'Blend', 'B over A, with the opacity that you choose.'],
  ['flip', 'Flip', 'A and B by turns.'],
]);

/** How pictures are drawn before anything is chosen. */
export const PLAIN_DRAWING = {
  exposure: 0,
  isRobust: true,
  isLogOfValues: null,
  isLogOfDifferences: null,
};

/**
 * What can be chosen, and who wants to know when it changes.
 * @template {object} C
 */
export class Choices {
  /** @param {C} choice */
  constructor(choice) {
    this.choice = choice;
    /** @type {Set<(changed: Set<keyof C>) => void>} */
    this.listeners = new Set();
  }

  /**
   * Changes some of it and tells the listeners what has changed.
   * @param {Partial<C>} changes
   */
  set(changes) {
    const names = /** @type {(keyof C)[]} */ (Object.keys(changes));
    const changed = new Set(names.filter((name) => !isSame(this.choice[name], changes[name])));
    if (changed.size > 0) {
      this.choice = { ...this.choice, ...changes };
      this.listeners.forEach((listener) => listener(changed));
    }
  }

  /** @param {(changed: Set<keyof C>) => void} listener */
  listen(listener) {
    this.listeners.add(listener);
  }
}

/** Whether two values are the same; pairs of numbers are if their numbers are. @param {unknown} a @param {unknown} b */
function isSame(a, b) {
  return a === b || (Array.isArray(a) && Array.isArray(b) && a[0] === b[0] && a[1] === b[1]);
}

/** What is chosen in the explorer. @extends {Choices<Choice>} */
export class State extends Choices {
  /** The cell that is read out: that under the pointer, else the selected one. */
  get reading() {
    const { hover, sensor, cell } = this.choice;
    return hover ?? (cell >= 0 ? { sensor, cell } : null);
  }
}
