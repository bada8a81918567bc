// Labels, marks and a bar of scale over the drive's 3-D picture.

import { LabelLayer } from '../view3d/labels.js';
import { OverlayCanvas } from '../view3d/overlay.js';
import { cssOfColour } from '../view3d/theme.js';
import { lengthInWords, roundStep } from '../view3d/words.js';

/** @typedef {import('../view3d/camera.js').ViewCamera} ViewCamera */
/** @typedef {import('../view3d/drawing.js').SceneDrawing} SceneDrawing */
/** @typedef {import('../view3d/labels.js').LabelBox} LabelBox */
/** @typedef {import('../view3d/labels.js').PlacedLabel} PlacedLabel */
/** @typedef {import('../gl/mesh.js').Rgb} Rgb */

/** Length of the bar of scale, CSS pixels, at most. */
const SCALE_LENGTH = 130;

export class DriveOverlay {
  /** @param {HTMLCanvasElement} canvas @param {HTMLElement} labels */
  constructor(canvas, labels) {
    this.canvas = new OverlayCanvas(canvas);
    this.labels = new LabelLayer(labels);
  }

  /** @param {ViewCamera} camera @param {SceneDrawing} drawing @param {Record<string, Rgb>} colours */
  draw(camera, drawing, colours) {
    const { canvas } = this;
    const { width, height } = camera;
    const css = (/** @type {string} */ name) => cssOfColour(colours[name]);
    canvas.begin(width, height, Math.min(window.devicePixelRatio || 1, 3));
    /** @type {PlacedLabel[]} */
    const placed = [];
    for (const { at, text, colour, priority } of drawing.labels) {
      const place = camera.project(at);
      if (place) { placed.push({ x: place[0], y: place[1], text, colour: css(colour), priority, isTick: false }); }
    }
    /** @type {LabelBox[]} */
    const taken = [];
    if (camera.pose.lens.kind === 'angle') {
      const scale = camera.metresPerPixel;
      const length = roundStep(Math.min(SCALE_LENGTH, width / 3) * scale);
      taken.push({ left: 0, top: height - 36, right: length / scale + 30, bottom: height });
      const font = '600 12px system-ui, sans-serif';
      canvas.scaleBar(length / scale, lengthInWords(length), height, css('ink'), css('sky'), font);
    }
    canvas.leaders(this.labels.show(placed, width, height, taken));
    for (const { at, shape, colour } of drawing.marks) {
      const place = camera.project(at);
      if (place) { canvas.mark(place[0], place[1], shape, css(colour), css('paper')); }
    }
  }
}
