// The known cells of the map as faces: each cell a square with its elevation in the middle. Corners lie at the mean
// of the cells that meet there, so that neighbours join.

import { NO_SLOT } from './replay.js';

/** @typedef {import('./raster.js').CellPaint} CellPaint */
/** @typedef {import('./replay.js').MapReplay} MapReplay */
/** @typedef {import('./solid.js').SolidMesh} SolidMesh */

/** Cells of the rectangle around all known ones, at most. Beyond it every second one is drawn, and so on. */
const LARGEST_SURFACE = 600000;

/** Rectangle around the cells that are known now, or null. @param {MapReplay} replay */
function knownBox(replay) {
  let [left, bottom, right, top] = [Infinity, Infinity, -Infinity, -Infinity];
  for (let slot = 0; slot < replay.slotCount; slot += 1) {
    if (replay.source[slot] === 0) { continue; }
    const [i, j] = replay.cellOfSlot(slot);
    if (i < left) { left = i; }
    if (i > right) { right = i; }
    if (j < bottom) { bottom = j; }
    if (j > top) { top = j; }
  }
  return left <= right ? { left, bottom, right, top } : null;
}

/**
 * @param {CellPaint} paint @param {number} lift metres above the elevation
 * @returns {SolidMesh}
 */
export function cellSurface(paint, lift) {
  const { replay } = paint;
  const box = knownBox(replay);
  if (!box) {
    return { positions: new Float32Array(0), colours: new Uint32Array(0), indices: new Uint32Array(0) };
  }
  const cells = (box.right - box.left + 1) * (box.top - box.bottom + 1);
  const step = Math.max(1, Math.ceil(Math.sqrt(cells / LARGEST_SURFACE)));
  const columns = Math.floor((box.right - box.left) / step) + 1;
  const rows = Math.floor((box.top - box.bottom) / step) + 1;
  const slots = replay.slotsIn(box.left, box.bottom, columns, rows, step);
  const isKnown = (/** @type {number} */ slot) => slot !== NO_SLOT && replay.source[slot] !== 0;
  // Corners first: sum and number of the cells about each.
  const across = columns + 1;
  const corners = across * (rows + 1);
  const sums = new Float64Array(corners);
  const counts = new Uint8Array(corners);
  let known = 0;
  for (let at = 0; at < slots.length; at += 1) {
    if (!isKnown(slots[at])) { continue; }
    known += 1;
    const corner = at + Math.floor(at / columns);
    for (const place of [corner, corner + 1, corner + across, corner + across + 1]) {
      sums[place] += replay.elevation[slots[at]];
      counts[place] += 1;
    }
  }
  const positions = new Float32Array(3 * (corners + known));
  const colours = new Uint32Array(corners + known);
  const indices = new Uint32Array(12 * known);
  const size = replay.record.spacing * step;
  const [x0, y0] = replay.placeOf(box.left, box.bottom);
  for (let corner = 0; corner < corners; corner += 1) {
    const row = Math.floor(corner / across);
    positions[3 * corner] = x0 + (corner - row * across - 0.5) * size;
    positions[3 * corner + 1] = y0 + (row - 0.5) * size;
    positions[3 * corner + 2] = counts[corner] > 0 ? sums[corner] / counts[corner] + lift : 0;
  }
  let vertex = corners;
  let index = 0;
  for (let at = 0; at < slots.length; at += 1) {
    const slot = slots[at];
    if (!isKnown(slot)) { continue; }
    const row = Math.floor(at / columns);
    const corner = at + row;
    positions[3 * vertex] = x0 + (at - row * columns) * size;
    positions[3 * vertex + 1] = y0 + row * size;
    positions[3 * vertex + 2] = replay.elevation[slot] + lift;
    colours[vertex] = paint.colourOf(slot);
    // Four triangles about the middle. It comes last, so that its colour is theirs.
    const ring = [corner, corner + 1, corner + across + 1, corner + across];
    for (let k = 0; k < 4; k += 1) {
      indices[index] = ring[k];
      indices[index + 1] = ring[(k + 1) % 4];
      indices[index + 2] = vertex;
      index += 3;
    }
    vertex += 1;
  }
  return { positions, colours, indices };
}
