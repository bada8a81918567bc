// What is drawn over a picture: axes in cells, the grid, and the numbers in large cells.

import { cellWords, roundAbove } from '../data/numbers.js';
import { inkOn } from './colour.js';
import { axisWords } from './axis_words.js';

/** @typedef {import('./viewport.js').Viewport} Viewport */
/** @typedef {import('./painter.js').Layer} Layer */
/** @typedef {import('../data/page_model.js').RasterAxis} RasterAxis */
/** @typedef {import('../data/page_model.js').RasterAxes} RasterAxes */

/** Cells from this size on have their numbers: CSS pixels. */
const NUMBERED_CELL = 44;
/** Cells from this size on are separated by lines: CSS pixels. */
const GRID_CELL = 9;

/** @param {CanvasRenderingContext2D} context @param {Viewport} view */
export function drawGrid(context, view) {
  if (Math.min(view.scaleX, view.scaleY) < GRID_CELL * view.ratio) {
    return;
  }
  const cells = view.visibleCells();
  const line = Math.max(1, Math.round(view.ratio));
  context.fillStyle = 'rgba(0, 0, 0, 0.35)';
  for (let i = cells.left; i <= cells.right; i += 1) {
    context.fillRect(view.left + i * view.scaleX, 0, line, view.height);
  }
  for (let j = cells.top; j <= cells.bottom; j += 1) {
    context.fillRect(0, view.top + j * view.scaleY, view.width, line);
  }
}

/**
 * @param {CanvasRenderingContext2D} context @param {Viewport} view @param {Layer} top @param {Layer[]} layers
 */
export function drawNumbers(context, view, top, layers) {
  const cellWidth = view.scaleX / view.ratio;
  const cellHeight = view.scaleY / view.ratio;
  if (cellWidth < NUMBERED_CELL || cellHeight < 14 || !top.values) {
    return;
  }
  const size = Math.min(13, Math.max(9.5, cellWidth / 6.5));
  const room = Math.max(4, Math.min(12, Math.floor((cellWidth - 4) / (size * 0.6))));
  context.font = `${size * view.ratio}px ui-monospace, Menlo, Consolas, "DejaVu Sans Mono", monospace`;
  context.textAlign = 'center';
  context.textBaseline = 'middle';
  const cells = view.visibleCells();
  const shown = layers.length > 1 && cellHeight >= 2.6 * size ? layers : [top];
  for (let j = cells.top; j < cells.bottom; j += 1) {
    for (let i = cells.left; i < cells.right; i += 1) {
      const cell = j * view.columns + i;
      const x = view.left + (i + 0.5) * view.scaleX;
      const y = view.top + (j + 0.5) * view.scaleY;
      const ground = top.pixels[cell];
      context.fillStyle = ground === 0 ? '#000000' : inkOn(ground);
      shown.forEach((layer, line) => {
        const text = (shown.length > 1 ? `${layer.of.toUpperCase()} ` : '') + wordsIn(layer, cell, room);
        context.fillText(
          text,
          x,
          y + (line - (shown.length - 1) / 2) * size * 1.35 * view.ratio,
          view.scaleX,
        );
      });
    }
  }
}

/** @param {Layer} layer @param {number} cell @param {number} room characters */
function wordsIn(layer, cell, room) {
  const value = layer.values?.[cell] ?? NaN;
  if (layer.channel.drawing === 'faces') {
    return value === 4294967295 ? '' : String(value);
  }
  return value === 4294967295 ? '' : cellWords(value, room);
}

/** Steps of angles that people count in, degrees. */
const TURN_STEPS = [1, 2, 5, 10, 15, 30, 45, 90, 180, 360];

/**
 * Columns below, rows at the left: their numbers, or what they are.
 * @param {CanvasRenderingContext2D} context @param {Viewport} view
 * @param {{x: number, y: number, width: number, height: number}} area @param {CSSStyleDeclaration} ink
 * @param {RasterAxes|null} axes
 */
export function drawAxes(context, view, area, ink, axes) {
  const ratio = view.ratio;
  const soft = ink.getPropertyValue('--soft').trim() || '#5b6068';
  context.fillStyle = soft;
  context.font = `${11 * ratio}px system-ui, sans-serif`;
  const cells = view.visibleCells();
  context.textAlign = 'center';
  context.textBaseline = 'top';
  const room = 64 * ratio;
  const columns = axes
    ? ticksAlong(axes.columns, cells.left, cells.right, view.scaleX, room)
    : cellTicks(cells.left, cells.right, view.scaleX, room, String);
  let free = -Infinity;
  for (const { at, words } of columns) {
    const x = view.left + at * view.scaleX;
    const half = context.measureText(words).width / 2;
    if (x < 0 || x > area.width) {
      continue;
    }
    context.fillRect(area.x + x, area.y + area.height, ratio, 4 * ratio);
    const kept = Math.min(area.x + x, area.x + area.width - half);
    if (kept - half >= free) {
      context.fillText(words, kept, area.y + area.height + 6 * ratio);
      free = kept + half + 4 * ratio;
    }
  }
  const ofRow = (/** @type {number} */ j) => (axes ? axisWords(axes.rows, axes.rows.at[j]) : String(j));
  const rows = cellTicks(cells.top, cells.bottom, view.scaleY, (axes ? 13 : 26) * ratio, ofRow);
  context.textAlign = 'right';
  context.textBaseline = 'middle';
  for (const { at, words } of rows) {
    const y = view.top + at * view.scaleY;
    if (y < 0 || y > area.height) {
      continue;
    }
    context.fillRect(area.x - 4 * ratio, area.y + y, 4 * ratio, ratio);
    const kept = Math.min(Math.max(area.y + y, area.y + 6 * ratio), area.y + area.height - 5 * ratio);
    context.fillText(words, area.x - 7 * ratio, kept);
  }
  if (axes) {
    context.textAlign = 'center';
    context.textBaseline = 'bottom';
    context.fillText(axes.columns.name, area.x + area.width / 2, area.y + area.height + 34 * ratio);
    context.save();
    context.translate(11 * ratio, area.y + area.height / 2);
    context.rotate(-Math.PI / 2);
    context.textBaseline = 'middle';
    context.fillText(axes.rows.name, 0, 0);
    context.restore();
  }
}

/**
 * Ticks in the middles of cells.
 * @param {number} first @param {number} end @param {number} scale @param {number} room pixels
 * @param {(cell: number) => string} wordsOf
 * @returns {{at: number, words: string}[]}
 */
function cellTicks(first, end, scale, room, wordsOf) {
  const step = tickStep(scale, room);
  const ticks = [];
  for (let cell = Math.ceil(first / step) * step; cell < end; cell += step) {
    ticks.push({ at: cell + 0.5, words: wordsOf(cell) });
  }
  return ticks;
}

/**
 * Ticks at round numbers of an axis, between the cells that have them.
 * @param {RasterAxis} axis @param {number} first @param {number} end cells @param {number} scale
 * @param {number} room pixels
 * @returns {{at: number, words: string}[]}
 */
function ticksAlong(axis, first, end, scale, room) {
  const { at } = axis;
  const count = at.length;
  const each = Math.abs(at[count - 1] - at[0]) / Math.max(1, count - 1);
  if (!(each > 0)) {
    return cellTicks(first, end, scale, room, (cell) => axisWords(axis, at[cell]));
  }
  const rough = (room / scale) * each;
  const round = axis.turns && rough >= 1 ? TURN_STEPS.find((size) => size >= rough) : undefined;
  const step = round ?? roundAbove(rough);
  const ticks = [];
  for (let cell = first; cell < Math.min(end, count - 1); cell += 1) {
    const [from, to] = [at[cell], at[cell + 1]];
    const value = step * (to > from ? Math.ceil(from / step) : Math.floor(from / step));
    const share = (value - from) / (to - from);
    if (share >= 0 && share < 1) {
      ticks.push({ at: cell + 0.5 + share, words: axisWords(axis, value) });
    }
  }
  return ticks;
}

/** Cells between ticks: 1, 2 or 5 times a power of ten. @param {number} scale @param {number} room pixels */
function tickStep(scale, room) {
  return roundAbove(Math.max(1, room / scale));
}
