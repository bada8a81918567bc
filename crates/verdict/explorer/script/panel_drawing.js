// What is drawn over a picture: axes in cells, the grid, and the numbers in large cells.

import { cellWords } from './numbers.js';
import { inkOn } from './colour.js';

/** @typedef {import('./viewport.js').Viewport} Viewport */
/** @typedef {import('./painter.js').Layer} Layer */

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

/**
 * Columns below, rows at the left.
 * @param {CanvasRenderingContext2D} context @param {Viewport} view
 * @param {{x: number, y: number, width: number, height: number}} area @param {CSSStyleDeclaration} ink
 */
export function drawAxes(context, view, area, ink) {
  const ratio = view.ratio;
  const soft = ink.getPropertyValue('--soft').trim() || '#5b6068';
  context.fillStyle = soft;
  context.font = `${11 * ratio}px system-ui, sans-serif`;
  const cells = view.visibleCells();
  const stepX = tickStep(view.scaleX, 64 * ratio);
  context.textAlign = 'center';
  context.textBaseline = 'top';
  for (let i = Math.ceil(cells.left / stepX) * stepX; i < cells.right; i += stepX) {
    const x = view.left + (i + 0.5) * view.scaleX;
    const half = context.measureText(String(i)).width / 2;
    if (x < 0 || x > area.width) {
      continue;
    }
    context.fillRect(area.x + x, area.y + area.height, ratio, 4 * ratio);
    const kept = Math.min(area.x + x, area.x + area.width - half);
    context.fillText(String(i), kept, area.y + area.height + 6 * ratio);
  }
  const stepY = tickStep(view.scaleY, 26 * ratio);
  context.textAlign = 'right';
  context.textBaseline = 'middle';
  for (let j = Math.ceil(cells.top / stepY) * stepY; j < cells.bottom; j += stepY) {
    const y = view.top + (j + 0.5) * view.scaleY;
    if (y < 0 || y > area.height) {
      continue;
    }
    context.fillRect(area.x - 4 * ratio, area.y + y, 4 * ratio, ratio);
    const kept = Math.min(Math.max(area.y + y, area.y + 6 * ratio), area.y + area.height - 5 * ratio);
    context.fillText(String(j), area.x - 7 * ratio, kept);
  }
}

/** Cells between ticks: 1, 2 or 5 times a power of ten. @param {number} scale @param {number} room pixels */
function tickStep(scale, room) {
  const rough = room / scale;
  if (rough <= 1) {
    return 1;
  }
  const decade = 10 ** Math.floor(Math.log10(rough));
  return [1, 2, 5, 10].map((factor) => factor * decade).find((step) => step >= rough) ?? 10 * decade;
}
