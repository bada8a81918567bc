// What is written into large cells of the map: marks of sources, and numbers.

import { inkOn } from '../panel/colour.js';
import { NO_SLOT } from './replay.js';

/** @typedef {import('./raster.js').CellPaint} CellPaint */
/** @typedef {import('./raster.js').CellBox} CellBox */
/** @typedef {import('./plan.js').PlanView} PlanView */

/** Cells that are smaller have no marks, and no numbers: CSS pixels. */
const MARKED_MAP_CELL = 13;
const NUMBERED_MAP_CELL = 52;

/** Mark of each source, for people who do not see its colour. Measured cells have none. */
export const SOURCE_MARKS = ['', '•', '/', ''];

/**
 * @param {CanvasRenderingContext2D} context @param {PlanView} view @param {CellPaint} paint @param {CellBox} box
 * @param {number} shift what is added to elevations for the global frame, metres
 */
export function drawCellMarks(context, view, paint, box, shift) {
  const { replay, colouring, truth } = paint;
  const size = replay.record.spacing * view.scale;
  const isNumbered = size >= NUMBERED_MAP_CELL;
  if (size < MARKED_MAP_CELL || (colouring !== 'source' && !isNumbered)) {
    return;
  }
  context.font = `${isNumbered ? 11 : Math.round(Math.min(12, size * 0.7))}px system-ui, sans-serif`;
  context.textAlign = 'center';
  context.textBaseline = 'middle';
  for (let j = box.bottom; j <= box.top; j += 1) {
    for (let i = box.left; i <= box.right; i += 1) {
      const slot = replay.slotOf(i, j);
      if (slot === NO_SLOT || replay.source[slot] === 0) { continue; }
      const [x, y] = replay.placeOf(i, j);
      const elevation = replay.elevation[slot];
      const value = colouring === 'error' ? elevation - (truth ? truth.heightOf(slot) : NaN) : elevation + shift;
      const mark = colouring === 'source' ? SOURCE_MARKS[replay.source[slot]] : '';
      const text = isNumbered ? `${value.toFixed(3).replace('-', '−')}${mark ? ` ${mark}` : ''}` : mark;
      context.fillStyle = inkOn(paint.colourOf(slot));
      context.fillText(text, view.pixelX(x), view.pixelY(y));
    }
  }
}
