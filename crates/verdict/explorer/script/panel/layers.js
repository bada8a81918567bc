// The layers of a picture on its canvas: one, both side by side, or one over the other. Below is hatching.

/** @typedef {import('./viewport.js').Viewport} Viewport */
/** @typedef {import('./painter.js').Layer} Layer */
/** @typedef {import('../state.js').Choice} Choice */

/**
 * @param {CanvasRenderingContext2D} context
 * @param {Viewport} view
 * @param {Layer[]} layers
 * @param {Choice} choice
 * @param {CSSStyleDeclaration} ink
 */
export function drawLayers(context, view, layers, choice, ink) {
  const { mode, divider, opacity, flipShowsB } = choice;
  const cells = view.visibleCells();
  const [across, down] = [cells.right - cells.left, cells.bottom - cells.top];
  const [x, y] = [view.left + cells.left * view.scaleX, view.top + cells.top * view.scaleY];
  const [width, height] = [across * view.scaleX, down * view.scaleY];
  if (across <= 0 || down <= 0) {
    return;
  }
  context.fillStyle = hatchPattern(context, ink, view.ratio);
  context.fillRect(x, y, width, height);
  const part = { left: cells.left, top: cells.top, across, down };
  /** @param {Layer} layer */
  const put = (layer) => putLayer(context, view, layer, part, { x, y, width, height });
  const [first, second] = layers;
  if (!first) {
    return;
  }
  if (!second) {
    put(first);
  } else if (mode === 'flip') {
    put(flipShowsB ? second : first);
  } else if (mode === 'blend') {
    put(first);
    context.globalAlpha = opacity;
    put(second);
    context.globalAlpha = 1;
  } else {
    const line = Math.round(divider * view.width);
    putWithin(context, view, 0, line, () => put(first));
    putWithin(context, view, line, view.width, () => put(second));
  }
}

/**
 * Draws a part of a layer. If cells are smaller than pixels, colours of a scale are averaged; colours that
 * only name something are not.
 * @param {CanvasRenderingContext2D} context
 * @param {Viewport} view
 * @param {Layer} layer
 * @param {{left: number, top: number, across: number, down: number}} part cells
 * @param {{x: number, y: number, width: number, height: number}} place pixels
 */
function putLayer(context, view, layer, part, place) {
  const averages = view.scaleX < 1 && (layer.scale !== null || layer.channel.drawing === 'normal');
  const { left, top, across, down } = part;
  const { x, y, width, height } = place;
  context.imageSmoothingEnabled = averages;
  context.imageSmoothingQuality = 'medium';
  if (!averages || view.scaleY <= 1) {
    context.drawImage(layer.canvas, left, top, across, down, x, y, width, height);
    return;
  }
  // Rows of a flat sensor are higher than pixels. Columns are averaged first, so that rows do not mix.
  const narrow = document.createElement('canvas');
  narrow.width = Math.max(1, Math.round(width));
  narrow.height = down;
  const brush = narrow.getContext('2d');
  if (brush) {
    brush.imageSmoothingQuality = 'medium';
    brush.drawImage(layer.canvas, left, top, across, down, 0, 0, narrow.width, down);
    context.imageSmoothingEnabled = false;
    context.drawImage(narrow, x, y, width, height);
  }
}

/**
 * @param {CanvasRenderingContext2D} context @param {Viewport} view @param {number} from @param {number} to
 * @param {() => void} put
 */
function putWithin(context, view, from, to, put) {
  context.save();
  context.beginPath();
  context.rect(from, 0, to - from, view.height);
  context.clip();
  put();
  context.restore();
}

/**
 * The hatching where nothing is hit.
 * @param {CanvasRenderingContext2D} context @param {CSSStyleDeclaration} ink @param {number} ratio
 * @returns {CanvasPattern|string}
 */
function hatchPattern(context, ink, ratio) {
  const side = Math.max(4, Math.round(8 * ratio));
  const tile = document.createElement('canvas');
  tile.width = side;
  tile.height = side;
  const brush = tile.getContext('2d');
  const [ground, line] = ['--hatch-a', '--hatch-b'].map(
    (name) => ink.getPropertyValue(name).trim() || '#c8c5be',
  );
  if (!brush) {
    return ground;
  }
  brush.fillStyle = ground;
  brush.fillRect(0, 0, side, side);
  brush.strokeStyle = line;
  brush.lineWidth = side / 2.8;
  brush.beginPath();
  for (const shift of [-side, 0, side]) {
    brush.moveTo(shift - side, side * 2);
    brush.lineTo(shift + side * 2, -side);
  }
  brush.stroke();
  return context.createPattern(tile, 'repeat') ?? ground;
}
