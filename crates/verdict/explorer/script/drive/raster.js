// The cells of the map as a picture: coloured by elevation, source or error, with the shade of hills.

import { canvasOfPixels, packedColour, packedHex } from '../panel/colour.js';
import { coloursOf } from '../panel/painter.js';
import { NO_SLOT } from './replay.js';
import { SOURCE_COLOURS } from './looks.js';

/** @typedef {import('./replay.js').MapReplay} MapReplay */
/** @typedef {import('./ground.js').DriveGround} DriveGround */
/** @typedef {import('./looks.js').DriveTheme} DriveTheme */
/** @typedef {import('../data/limits.js').ColourScale} ColourScale */
/** @typedef {import('./scale.js').MapColouring} MapColouring */
/** @typedef {{left: number, bottom: number, right: number, top: number}} CellBox first and last i and j */

/** Cells of a picture; of more, every second is drawn, every third, and so on. */
const LARGEST_PICTURE = 700000;

/** Where the light comes from: from the upper left, as on maps. */
const HILL_LIGHT = { x: -0.5, y: 0.5, z: 0.707 };

/** The light on a slope, 0 to 1. @param {number} slopeX rise over distance @param {number} slopeY */
export function hillShade(slopeX, slopeY) {
  const length = Math.sqrt(slopeX * slopeX + slopeY * slopeY + 1);
  const light = (HILL_LIGHT.z - slopeX * HILL_LIGHT.x - slopeY * HILL_LIGHT.y) / length;
  return Math.max(0, Math.min(1, light));
}

/** A colour, made darker or lighter. @param {number} packed @param {number} factor 1: as it is */
function shadedColour(packed, factor) {
  const part = (/** @type {number} */ value) => Math.min(255, Math.round(value * factor));
  return packedColour(part(packed & 255), part((packed >> 8) & 255), part((packed >> 16) & 255));
}

/** Heights of the true ground under cells, computed once each. */
export class CellTruth {
  /** @param {MapReplay} replay @param {DriveGround} ground */
  constructor(replay, ground) {
    this.replay = replay;
    this.ground = ground;
    this.heights = new Float32Array(replay.slotCount);
    this.isKnown = new Uint8Array(replay.slotCount);
  }

  /** Height under a slot's grid point, scene frame; NaN where there is no ground. @param {number} slot */
  heightOf(slot) {
    if (this.isKnown[slot] === 0) {
      const [x, y] = this.replay.placeOf(...this.replay.cellOfSlot(slot));
      this.heights[slot] = this.ground.heightAt(x, y);
      this.isKnown[slot] = 1;
    }
    return this.heights[slot];
  }
}

/** The colour of a cell, without shade. */
export class CellPaint {
  /**
   * @param {MapReplay} replay @param {MapColouring} colouring @param {ColourScale|null} scale null for sources
   * @param {CellTruth|null} truth @param {DriveTheme} theme
   */
  constructor(replay, colouring, scale, truth, theme) {
    this.replay = replay;
    this.colouring = colouring;
    this.truth = truth;
    this.ofValue = scale ? coloursOf(scale) : () => this.none;
    this.ofSource = SOURCE_COLOURS.map((name) => (name ? packedHex(theme[name]) : 0));
    this.none = packedHex(theme.soft);
  }

  /** Colour of a known slot, packed. @param {number} slot */
  colourOf(slot) {
    if (this.colouring === 'source') {
      return this.ofSource[this.replay.source[slot]];
    }
    let value = this.replay.elevation[slot];
    if (this.colouring === 'error') {
      value -= this.truth ? this.truth.heightOf(slot) : NaN;
    }
    return Number.isNaN(value) ? this.none : this.ofValue(value);
  }
}

/**
 * Paints a rectangle of cells. `step` is the distance of the cells in the picture; row 0 is the top.
 * @param {CellPaint} paint @param {CellBox} box @param {boolean} isShaded
 * @returns {{canvas: HTMLCanvasElement, left: number, bottom: number, columns: number, rows: number,
 *   step: number}}
 */
export function cellPicture(paint, box, isShaded) {
  const { replay } = paint;
  const cells = (box.right - box.left + 1) * (box.top - box.bottom + 1);
  const step = Math.max(1, Math.ceil(Math.sqrt(cells / LARGEST_PICTURE)));
  // Multiples of the step, so that the same cells are drawn wherever the picture begins.
  const first = Math.floor(box.left / step) * step;
  const bottom = Math.floor(box.bottom / step) * step;
  const columns = Math.floor((box.right - first) / step) + 1;
  const rows = Math.floor((box.top - bottom) / step) + 1;
  const slots = replay.slotsIn(first, bottom, columns, rows, step);
  const pixels = new Uint32Array(columns * rows);
  const { elevation, source } = replay;
  const spacing = replay.record.spacing * step;
  const isFaint = paint.colouring === 'error';
  // Rise to a neighbour; 0 where it is not known.
  const rise = (/** @type {number} */ here, /** @type {number} */ before, /** @type {number} */ after) => {
    const low = before === NO_SLOT || source[before] === 0 ? here : before;
    const high = after === NO_SLOT || source[after] === 0 ? here : after;
    const distance = (low === here ? 0 : 1) + (high === here ? 0 : 1);
    return distance === 0 ? 0 : (elevation[high] - elevation[low]) / (distance * spacing);
  };
  for (let row = 0; row < rows; row += 1) {
    for (let column = 0; column < columns; column += 1) {
      const at = row * columns + column;
      const slot = slots[at];
      if (slot === NO_SLOT || source[slot] === 0) { continue; }
      let colour = paint.colourOf(slot);
      if (isShaded) {
        const left = column > 0 ? slots[at - 1] : NO_SLOT;
        const right = column < columns - 1 ? slots[at + 1] : NO_SLOT;
        const below = row > 0 ? slots[at - columns] : NO_SLOT;
        const above = row < rows - 1 ? slots[at + columns] : NO_SLOT;
        const light = hillShade(rise(slot, left, right), rise(slot, below, above));
        colour = shadedColour(colour, isFaint ? 0.82 + 0.22 * light : 0.42 + 0.82 * light);
      }
      pixels[(rows - 1 - row) * columns + column] = colour;
    }
  }
  return { canvas: canvasOfPixels(pixels, columns, rows), left: first, bottom, columns, rows, step };
}
