// What the drive panel shows: the frame, the chosen sector and cell, and how the map is drawn.

/** @typedef {import('./scale.js').MapColouring} MapColouring */
/** @typedef {[number, number]} CellPlace i and j */
/**
 * @typedef {object} DriveChoice
 * @property {number} frame index in the page's frames
 * @property {number} sector of the current obstacle map; -1: none
 * @property {number} hoverSector -1: none
 * @property {CellPlace|null} cell chosen by a click or by keys
 * @property {CellPlace|null} hoverCell
 * @property {MapColouring} colouring
 * @property {boolean} isShaded
 * @property {boolean} hasRelief whether the true ground is seen in grey where the map knows nothing
 * @property {boolean} hasSectors
 * @property {boolean} mapFollows
 * @property {boolean} viewFollows
 * @property {boolean} isPlaying
 * @property {number} speed
 */
/** @typedef {(changed: Set<keyof DriveChoice>) => void} DriveListener */

export class DriveState {
  constructor() {
    /** @type {DriveChoice} */
    this.choice = {
      frame: 0, sector: -1, hoverSector: -1, cell: null, hoverCell: null, colouring: 'elevation', isShaded: true,
      hasRelief: true, hasSectors: true, mapFollows: false, viewFollows: false, isPlaying: false, speed: 1,
    };
    /** @type {DriveListener[]} */
    this.listeners = [];
  }

  /** @param {DriveListener} listener */
  onChange(listener) {
    this.listeners.push(listener);
  }

  /** Sets parts of the choice, and tells the listeners what has changed. @param {Partial<DriveChoice>} part */
  set(part) {
    /** @type {Set<keyof DriveChoice>} */
    const changed = new Set();
    for (const key of /** @type {(keyof DriveChoice)[]} */ (Object.keys(part))) {
      if (!isSame(this.choice[key], part[key])) {
        changed.add(key);
      }
    }
    Object.assign(this.choice, part);
    if (changed.size > 0) {
      for (const listener of this.listeners) {
        listener(changed);
      }
    }
  }
}

/** Whether two values are the same; cells are if their numbers are. @param {unknown} a @param {unknown} b */
function isSame(a, b) {
  return a === b || (Array.isArray(a) && Array.isArray(b) && a[0] === b[0] && a[1] === b[1]);
}
