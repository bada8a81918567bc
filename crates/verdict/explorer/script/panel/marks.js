// Marks on a picture: where rays differ. Marks near each other are joined, so that the picture is still seen.

import { CLASS_LOOKS } from './colour.js';

/** @typedef {import('./viewport.js').Viewport} Viewport */
/** @typedef {{x: number, y: number, code: number, count: number, cell: number}} Mark */

/** Room for each mark of a picture, if there are many: square CSS pixels. */
const MARK_ROOM = 4200;

/** Cells from this size on get an outline of their own: CSS pixels. */
const OUTLINED_CELL = 9;

/**
 * The marks of the cells that can be seen: one for each square of the picture, of its worst class.
 * @param {Viewport} view @param {ArrayLike<number>} cells @param {ArrayLike<number>} codes classes
 * @returns {Mark[]}
 */
export function marksOf(view, cells, codes) {
  const isOutlined = view.scaleX >= OUTLINED_CELL * view.ratio;
  const [left, top, scaleX, scaleY] = [view.left, view.top, view.scaleX, view.scaleY];
  const most = Math.max(12, (view.width * view.height) / (MARK_ROOM * view.ratio * view.ratio));
  let side = 20 * view.ratio;
  for (;;) {
    /** @type {Map<number, Mark>} */
    const squares = new Map();
    for (let k = 0; k < cells.length; k += 1) {
      const column = cells[k] % view.columns;
      const x = left + (column + 0.5) * scaleX;
      const y = top + ((cells[k] - column) / view.columns + 0.5) * scaleY;
      if (x < 0 || y < 0 || x > view.width || y > view.height) {
        continue;
      }
      const across = Math.floor(x / side);
      const down = Math.floor(y / side);
      const square = isOutlined ? k : down * 10000 + across;
      const known = squares.get(square);
      if (!known) {
        squares.set(square, { x, y, code: codes[k], count: 1, cell: cells[k] });
        continue;
      }
      known.count += 1;
      // Of one class the cell in the middle of the square stands for all.
      const middleX = (across + 0.5) * side;
      const middleY = Math.min((down + 0.5) * side, view.height / 2 + down * side);
      const isNearer =
        (x - middleX) ** 2 + (y - middleY) ** 2 < (known.x - middleX) ** 2 + (known.y - middleY) ** 2;
      if (codes[k] > known.code || (codes[k] === known.code && isNearer)) {
        known.x = x;
        known.y = y;
        known.code = codes[k];
        known.cell = cells[k];
      }
    }
    if (isOutlined || squares.size <= most || side > view.width) {
      return [...squares.values()];
    }
    side *= 1.3;
  }
}

/**
 * @param {CanvasRenderingContext2D} context @param {Viewport} view @param {Mark[]} marks
 */
export function drawMarks(context, view, marks) {
  const ratio = view.ratio;
  const isOutlined = view.scaleX >= OUTLINED_CELL * ratio;
  for (const mark of marks) {
    const look = CLASS_LOOKS[mark.code] ?? CLASS_LOOKS[5];
    context.beginPath();
    if (isOutlined) {
      outlineCell(context, view, mark.cell);
    } else {
      shapePath(context, look.shape, mark.x, mark.y, 4.5 * ratio);
    }
    stroke(context, look.colour, ratio);
    if (mark.count > 1) {
      label(
        context,
        mark.count > 999 ? `${Math.round(mark.count / 1000)}k` : String(mark.count),
        mark.x + 7 * ratio,
        mark.y - 5 * ratio,
        ratio,
      );
    }
  }
}

/**
 * The cell that is selected.
 * @param {CanvasRenderingContext2D} context
 * @param {Viewport} view
 * @param {number} cell
 */
export function drawSelection(context, view, cell) {
  const x = view.left + (cell % view.columns) * view.scaleX;
  const y = view.top + Math.floor(cell / view.columns) * view.scaleY;
  const room = Math.max(0, (14 * view.ratio - view.scaleX) / 2);
  const roomY = Math.max(0, (14 * view.ratio - view.scaleY) / 2);
  context.beginPath();
  context.rect(x - room, y - roomY, view.scaleX + 2 * room, view.scaleY + 2 * roomY);
  const [middleX, middleY] = [x + view.scaleX / 2, y + view.scaleY / 2];
  for (const [dx, dy] of [
    [1, 0],
    [-1, 0],
    [0, 1],
    [0, -1],
  ]) {
    const [fromX, fromY] = [view.scaleX / 2 + room, view.scaleY / 2 + roomY];
    context.moveTo(middleX + dx * fromX, middleY + dy * fromY);
    context.lineTo(middleX + dx * (fromX + 9 * view.ratio), middleY + dy * (fromY + 9 * view.ratio));
  }
  stroke(context, '#ffffff', view.ratio);
}

/**
 * A line that is seen on any ground: black, and the colour within.
 * @param {CanvasRenderingContext2D} context
 * @param {string} colour
 * @param {number} ratio
 */
function stroke(context, colour, ratio) {
  context.lineWidth = 3.5 * ratio;
  context.strokeStyle = '#000000';
  context.stroke();
  context.lineWidth = 1.75 * ratio;
  context.strokeStyle = colour;
  context.stroke();
}

/** @param {CanvasRenderingContext2D} context @param {Viewport} view @param {number} cell */
function outlineCell(context, view, cell) {
  const x = view.left + (cell % view.columns) * view.scaleX;
  const y = view.top + Math.floor(cell / view.columns) * view.scaleY;
  context.rect(x, y, view.scaleX, view.scaleY);
}

/**
 * @param {CanvasRenderingContext2D} context @param {string} text @param {number} x @param {number} y
 * @param {number} ratio
 */
function label(context, text, x, y, ratio) {
  context.font = `600 ${9.5 * ratio}px system-ui, sans-serif`;
  context.textAlign = 'left';
  context.textBaseline = 'middle';
  context.lineWidth = 2.5 * ratio;
  context.strokeStyle = '#000000';
  context.strokeText(text, x, y);
  context.fillStyle = '#ffffff';
  context.fillText(text, x, y);
}

/**
 * The shape of a class about a point.
 * @param {CanvasRenderingContext2D|Path2D} path @param {string} shape @param {number} x @param {number} y
 * @param {number} r
 */
function shapePath(path, shape, x, y, r) {
  /** @param {[number, number][]} corners */
  const polygon = (corners) => {
    corners.forEach(([dx, dy], k) =>
      k === 0 ? path.moveTo(x + dx * r, y + dy * r) : path.lineTo(x + dx * r, y + dy * r),
    );
    path.closePath();
  };
  switch (shape) {
    case 'diamond':
      polygon([
        [0, -1.2],
        [1.2, 0],
        [0, 1.2],
        [-1.2, 0],
      ]);
      break;
    case 'triangle':
      polygon([
        [0, -1.15],
        [1.1, 0.9],
        [-1.1, 0.9],
      ]);
      break;
    case 'square':
      polygon([
        [-0.9, -0.9],
        [0.9, -0.9],
        [0.9, 0.9],
        [-0.9, 0.9],
      ]);
      break;
    case 'cross':
      for (const sign of [1, -1]) {
        path.moveTo(x - r, y - sign * r);
        path.lineTo(x + r, y + sign * r);
      }
      break;
    default:
      path.moveTo(x + r, y);
      path.arc(x, y, r, 0, 2 * Math.PI);
  }
}
