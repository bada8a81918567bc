// What the drive panel shows: the frame, the chosen sector and cell, and how the map is drawn.

import { Choices } from '../state.js';

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
/** @typedef {import('../state.js').Choices<DriveChoice>} DriveState */

/** What is shown before anything is chosen. @returns {DriveState} */
export function plainDriveState() {
  /** @type {DriveChoice} */
  const choice = {
    frame: 0, sector: -1, hoverSector: -1, cell: null, hoverCell: null, colouring: 'elevation', isShaded: true,
    hasRelief: true, hasSectors: true, mapFollows: false, viewFollows: false, isPlaying: false, speed: 1,
  };
  return new Choices(choice);
}
