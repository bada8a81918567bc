// What lies over the picture: labels and marks at their places, the bar of scale, the frame of the camera's
// image.

import { element } from '../elements.js';
import { LabelLayer } from './labels.js';
import { OverlayCanvas } from './overlay.js';
import { cssOfColour } from './theme.js';
import { lengthInWords, roundStep } from './words.js';

/** @typedef {import('./camera.js').ViewCamera} ViewCamera */
/** @typedef {import('./drawing.js').SceneDrawing} SceneDrawing */
/** @typedef {import('./drawing.js').MarkShape} MarkShape */
/** @typedef {import('./labels.js').LabelBox} LabelBox */
/** @typedef {import('./labels.js').PlacedLabel} PlacedLabel */
/** @typedef {import('./panel.js').ViewPanel} ViewPanel */
/** @typedef {import('./story.js').RayStory} RayStory */
/** @typedef {import('./theme.js').ColourName} ColourName */
/** @typedef {import('./theme.js').Rgb3} Rgb3 */
/** @typedef {import('./view3d.js').PageModel3d} PageModel3d */

/** Device pixels per CSS pixel of the marks, at most. */
const MARK_PIXEL_RATIO = 3;
/** Length of the bar of scale, CSS pixels, at most. */
const SCALE_LENGTH = 130;
const SCALE_FONT = '600 12px system-ui, sans-serif';

/** The labels and marks of drawings over any 3-D picture, and its bar of scale. */
export class SceneOverlay {
  /** @param {HTMLCanvasElement} canvas of the picture, over which it lies */
  constructor(canvas) {
    const overlay = element('canvas', { class: 'view3d-overlay', 'aria-hidden': 'true' });
    const labels = element('div', { class: 'view3d-labels', 'aria-hidden': 'true' });
    canvas.after(overlay, labels);
    this.overlay = new OverlayCanvas(overlay);
    this.labels = new LabelLayer(labels);
  }

  /**
   * @param {ViewCamera} camera
   * @param {SceneDrawing[]} drawings
   * @param {Record<string, Rgb3>} colours
   * @param {() => void} [drawBelow] draws what lies below the marks
   */
  draw(camera, drawings, colours, drawBelow) {
    const { overlay } = this;
    const { width, height } = camera;
    const css = (/** @type {string} */ name) => cssOfColour(colours[name]);
    overlay.begin(width, height, Math.min(window.devicePixelRatio || 1, MARK_PIXEL_RATIO));
    drawBelow?.();
    /** @type {LabelBox[]} */
    const taken = [];
    /** @type {{x: number, y: number, shape: MarkShape, colour: string}[]} */
    const marks = [];
    /** @type {PlacedLabel[]} */
    const placed = [];
    for (const drawing of drawings) {
      for (const { at, shape, colour } of drawing.marks) {
        const place = camera.project(at);
        if (!place) continue;
        const [x, y] = place;
        marks.push({ x, y, shape, colour });
        taken.push({ left: x - 8, top: y - 8, right: x + 8, bottom: y + 8 });
      }
      for (const { at, text, colour, priority, isTick } of drawing.labels) {
        const place = camera.project(at);
        if (!place) continue;
        const [x, y] = place;
        placed.push({ x, y, text, colour: css(colour), priority, isTick: isTick === true });
      }
    }
    if (camera.pose.lens.kind === 'angle') {
      const scale = camera.metresPerPixel;
      const length = roundStep(Math.min(SCALE_LENGTH, width / 3) * scale);
      taken.push({ left: 0, top: height - 36, right: length / scale + 30, bottom: height });
      overlay.scaleBar(length / scale, lengthInWords(length), height, css('ink'), css('sky'), SCALE_FONT);
    }
    overlay.leaders(this.labels.show(placed, width, height, taken));
    for (const { x, y, shape, colour } of marks) overlay.mark(x, y, shape, css(colour), css('paper'));
  }
}

/** The layers over the picture of rays: also the frame of the camera's image. */
export class OverPicture {
  /** @param {ViewPanel} panel @param {PageModel3d} model */
  constructor(panel, model) {
    this.panel = panel;
    this.model = model;
    this.scene = new SceneOverlay(panel.canvas);
  }

  /**
   * @param {ViewCamera} camera
   * @param {SceneDrawing[]} drawings
   * @param {Record<ColourName, Rgb3>} colours
   * @param {RayStory | null} story
   */
  draw(camera, drawings, colours, story) {
    const css = (/** @type {ColourName} */ name, opacity = 1) => cssOfColour(colours[name], opacity);
    this.scene.draw(camera, drawings, colours, () => {
      if (this.panel.root.dataset.view === 'camera') this.#drawFrame(camera, story, css);
    });
  }

  /**
   * The frame of the camera's image, and the pixel of the ray on it.
   * @param {ViewCamera} camera
   * @param {RayStory | null} story
   * @param {(name: ColourName, opacity?: number) => string} css
   */
  #drawFrame(camera, story, css) {
    const { lens } = camera.pose;
    if (lens.kind !== 'image') return;
    const { width, height, cellSize: cell } = camera;
    const box = (/** @type {number[]} */ [u, v, across, down]) => ({
      left: width / 2 + (u - lens.u) * cell,
      top: height / 2 + (v - lens.v) * cell,
      width: across * cell,
      height: down * cell,
    });
    const { overlay } = this.scene;
    overlay.frame(box([0, 0, lens.width, lens.height]), width, height, css('sky', 0.72), css('soft'));
    if (!story) return;
    const isOwn = this.model.sensors[story.sensor].kind === 'camera';
    const image = isOwn ? { u: story.i, v: story.j, onImage: true } : story.view?.image;
    if (!image?.onImage) return;
    overlay.cell(box([Math.floor(image.u), Math.floor(image.v), 1, 1]), css('seen'), css('paper'));
  }
}
