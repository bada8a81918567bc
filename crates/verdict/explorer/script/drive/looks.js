// How labels, sources and ways look: colours of drive.css, with dashes and marks for those who do not see colours.

import { hexOfStyle } from '../panel/colour.js';

/** @typedef {import('./model.js').DriveLabel} DriveLabel */
/** @typedef {'cross'|'query'|'ring'|'dot'} DriveMark */

/** Colours, each a custom property `--drive-NAME` of drive.css. */
const DRIVE_COLOURS = /** @type {const} */ ([
  'ink', 'paper', 'soft', 'grid', 'empty', 'true', 'believed', 'obstacle', 'unknown', 'visibility', 'waypoint',
  'cursor', 'body', 'proximity', 'extrapolated', 'measured',
]);

/** @typedef {typeof DRIVE_COLOURS[number]} DriveColour */
/** @typedef {Record<DriveColour, string>} DriveTheme `#rrggbb` */

/**
 * Dash (CSS pixels), mark and words of each label.
 * @type {Record<DriveLabel, {dash: number[], mark: DriveMark, words: string}>}
 */
export const LABEL_LOOKS = {
  obstacle: { dash: [], mark: 'cross', words: 'obstacle' },
  unknown: { dash: [7, 4], mark: 'query', words: 'unknown' },
  visibility: { dash: [2, 4], mark: 'ring', words: 'visibility limit' },
};

/** Colours of the sources of elevations, by number; 0 has none. @type {(DriveColour|null)[]} */
export const SOURCE_COLOURS = [null, 'proximity', 'extrapolated', 'measured'];

/** The colours in force on an element. @param {Element} host @returns {DriveTheme} */
export function readDriveTheme(host) {
  const style = getComputedStyle(host);
  const theme = /** @type {DriveTheme} */ ({});
  for (const name of DRIVE_COLOURS) { theme[name] = hexOfStyle(style, `--drive-${name}`); }
  return theme;
}

/**
 * Draws the mark of a label with an edge that stands out on every ground.
 * @param {CanvasRenderingContext2D} context @param {DriveMark} mark @param {number} x CSS pixels @param {number} y
 * @param {number} size half of its width @param {string} colour @param {string} edge
 */
export function drawMark(context, mark, x, y, size, colour, edge) {
  context.save();
  context.lineCap = 'round';
  context.setLineDash([]);
  if (mark === 'query') {
    // A square that stands on its corner, with a question mark.
    context.beginPath();
    context.moveTo(x, y - 1.5 * size);
    context.lineTo(x + 1.5 * size, y);
    context.lineTo(x, y + 1.5 * size);
    context.lineTo(x - 1.5 * size, y);
    context.closePath();
    context.fillStyle = colour;
    context.strokeStyle = edge;
    context.lineWidth = 1.2;
    context.fill();
    context.stroke();
    if (size > 5) {
      context.fillStyle = edge;
      context.font = `700 ${Math.round(2.1 * size)}px system-ui, sans-serif`;
      context.textAlign = 'center';
      context.textBaseline = 'middle';
      context.fillText('?', x, y + 0.5);
    }
    context.restore();
    return;
  }
  const thin = Math.min(2.2, 0.7 + 0.4 * size);
  for (const [width, paint] of /** @type {[number, string][]} */ ([[2 * thin + 0.3, edge], [thin, colour]])) {
    context.lineWidth = width;
    context.strokeStyle = paint;
    context.beginPath();
    if (mark === 'cross') {
      context.moveTo(x - size, y - size);
      context.lineTo(x + size, y + size);
      context.moveTo(x - size, y + size);
      context.lineTo(x + size, y - size);
    } else {
      context.arc(x, y, mark === 'dot' ? size / 2 : size, 0, 2 * Math.PI);
    }
    context.stroke();
  }
  context.restore();
}

/**
 * A small picture of a label's line and mark, for the key and the table.
 * @param {DriveLabel} label @param {DriveTheme} theme
 */
export function labelSwatch(label, theme) {
  const canvas = document.createElement('canvas');
  const ratio = 2;
  [canvas.width, canvas.height] = [38 * ratio, 16 * ratio];
  canvas.className = 'drive-swatch';
  canvas.setAttribute('aria-hidden', 'true');
  const context = canvas.getContext('2d');
  if (context) {
    context.scale(ratio, ratio);
    const look = LABEL_LOOKS[label];
    context.strokeStyle = theme[label];
    context.lineWidth = 2.4;
    context.setLineDash(look.dash);
    context.beginPath();
    context.moveTo(1, 8);
    context.lineTo(25, 8);
    context.stroke();
    drawMark(context, look.mark, 30, 8, 4, theme[label], theme.paper);
  }
  return canvas;
}
