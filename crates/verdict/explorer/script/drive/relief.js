// The true ground in grey, from above: what the map does not know yet. Painted once, in parts.

import { canvasOfPixels, packedColour } from '../panel/colour.js';
import { hillShade } from './raster.js';

/** @typedef {import('./ground.js').DriveGround} DriveGround */
/** @typedef {{left: number, bottom: number, right: number, top: number}} PlanBox metres, scene frame */
/** @typedef {{canvas: HTMLCanvasElement, box: PlanBox}} Relief */

/** Pixels along the longer side. */
const RELIEF_SIDE = 560;

/** Time that one part may take, milliseconds. */
const RELIEF_PART = 12;

/**
 * @param {DriveGround} ground @param {PlanBox} wanted @param {boolean} isDark
 * @returns {Promise<Relief|null>}
 */
export async function paintRelief(ground, wanted, isDark) {
  const box = {
    left: Math.max(wanted.left, ground.left), right: Math.min(wanted.right, ground.right),
    bottom: Math.max(wanted.bottom, ground.bottom), top: Math.min(wanted.top, ground.top),
  };
  const [width, height] = [box.right - box.left, box.top - box.bottom];
  if (!(width > 0 && height > 0)) {
    return null;
  }
  const step = Math.max(width, height) / RELIEF_SIDE;
  const columns = Math.max(1, Math.round(width / step));
  const rows = Math.max(1, Math.round(height / step));
  const heights = new Float32Array(columns * rows);
  let began = performance.now();
  for (let row = 0; row < rows; row += 1) {
    const y = box.top - (row + 0.5) * height / rows;
    for (let column = 0; column < columns; column += 1) {
      heights[row * columns + column] = ground.heightAt(box.left + (column + 0.5) * width / columns, y);
    }
    if (performance.now() - began > RELIEF_PART) {
      await new Promise((resolve) => { setTimeout(resolve, 0); });
      began = performance.now();
    }
  }
  return { canvas: canvasOfPixels(greys(heights, columns, rows, step, isDark), columns, rows), box };
}

/** @param {Float32Array} heights @param {number} columns @param {number} rows @param {number} step metres
 * @param {boolean} isDark */
function greys(heights, columns, rows, step, isDark) {
  const pixels = new Uint32Array(columns * rows);
  for (let row = 0; row < rows; row += 1) {
    for (let column = 0; column < columns; column += 1) {
      const at = row * columns + column;
      if (Number.isNaN(heights[at])) { continue; }
      const right = column < columns - 1 ? heights[at + 1] : heights[at];
      const above = row > 0 ? heights[at - columns] : heights[at];
      const light = hillShade((right - heights[at]) / step || 0, (above - heights[at]) / step || 0);
      const grey = Math.round(isDark ? 26 + 56 * light : 150 + 104 * light);
      pixels[at] = packedColour(grey, grey, Math.max(0, grey - 2));
    }
  }
  return pixels;
}
